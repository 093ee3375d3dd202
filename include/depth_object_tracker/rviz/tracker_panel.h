// SPDX-License-Identifier: BSD-3-Clause
// rviz panel of one tracker: state, reason, buttons, and the figures that say how well it goes.
#pragma once

#include <depth_object_tracker/TrackerStatus.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <rviz/panel.h>

#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QTimer>

#include <chrono>
#include <functional>
#include <future>
#include <string>

namespace depth_object_tracker {

class StateLight;
class ValuePlot;

/// Widgets are touched by the GUI's thread alone; statuses come from any thread.
class TrackerPanel : public rviz::Panel {
  Q_OBJECT

 public:
  explicit TrackerPanel(QWidget* parent = nullptr);
  ~TrackerPanel() override;

  void load(const rviz::Config& config) override;
  void save(rviz::Config config) const override;

  /// @param name of the tracker nodelet: its topics and services lie below.
  void setTracker(const QString& name);

 private:
  /// A service call on a thread of its own; what it returns is shown.
  using Call = std::function<std::string()>;

  QWidget* makeHead();
  QWidget* makeButtons();
  QWidget* makePlots();
  QPushButton* makeButton(const char* name, const QString& text, const QString& tip);

  void showStatus(const TrackerStatus& status);
  void showSilence();
  void start(Call call);
  void lookForAnswer();
  void setButtonsEnabled(bool enabled);

  ros::NodeHandle node_;
  ros::Subscriber subscriber_;
  QString tracker_;
  bool is_paused_ = false;
  std::future<std::string> answer_;
  std::chrono::steady_clock::time_point last_status_at_;
  QTimer timer_;

  StateLight* light_ = nullptr;
  QLabel *state_ = nullptr, *reason_ = nullptr, *answer_label_ = nullptr;
  QLineEdit* tracker_edit_ = nullptr;
  QPushButton *initialise_ = nullptr, *reset_ = nullptr, *pause_ = nullptr;
  ValuePlot *visible_plot_ = nullptr, *score_plot_ = nullptr, *latency_plot_ = nullptr;
};

}  // namespace depth_object_tracker
