// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/rviz/tracker_panel.h"

#include "depth_object_tracker/rviz/state_light.h"
#include "depth_object_tracker/rviz/value_plot.h"

#include <ros/service.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <QHBoxLayout>
#include <QVBoxLayout>

#include <cmath>
#include <limits>
#include <utility>

namespace depth_object_tracker {
namespace {

constexpr int kTimerMs = 100;
constexpr std::chrono::seconds kSilence{3};  // the nodelet speaks once a second at least
constexpr const char* kDefaultTracker = "/tracker";

struct StateLook {
  const char* name;
  QColor color;
};

StateLook lookOf(const TrackerStatus& status) {
  if (status.paused) return {"PAUSED", QColor(120, 130, 145)};
  switch (status.state) {
    case TrackerStatus::INITIALIZING:
      return {"INITIALIZING", QColor(70, 140, 230)};
    case TrackerStatus::TRACKING:
      return {"TRACKING", QColor(50, 185, 80)};
    case TrackerStatus::OCCLUDED:
      return {"OCCLUDED", QColor(240, 180, 30)};
    case TrackerStatus::LOST:
      return {"LOST", QColor(220, 50, 45)};
    default:
      return {"UNINITIALIZED", QColor(150, 150, 150)};
  }
}

template <typename Service>
std::string callService(const std::string& name, Service service) {
  if (!ros::service::exists(name, false)) return name + ": no such service; is the tracker running?";
  if (!ros::service::call(name, service)) return name + ": the call failed";
  return service.response.message;
}

QString percent(double value) {
  return QString::number(std::lround(100.0 * value)) + " %";
}

}  // namespace

TrackerPanel::TrackerPanel(QWidget* parent) : rviz::Panel(parent) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(8, 6, 8, 6);
  layout->addWidget(makeHead());
  layout->addWidget(makeButtons());
  answer_label_ = new QLabel(this);
  answer_label_->setObjectName("answer");
  answer_label_->setWordWrap(true);
  answer_label_->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  answer_label_->setMinimumHeight(2 * fontMetrics().lineSpacing());
  layout->addWidget(answer_label_);
  layout->addWidget(makePlots(), 1);
  connect(&timer_, &QTimer::timeout, this, [this] {
    lookForAnswer();
    if (std::chrono::steady_clock::now() - last_status_at_ > kSilence) showSilence();
  });
  timer_.start(kTimerMs);
  setTracker(kDefaultTracker);
}

TrackerPanel::~TrackerPanel() {
  subscriber_.shutdown();
}

QWidget* TrackerPanel::makeHead() {
  auto* head = new QWidget(this);
  auto* layout = new QVBoxLayout(head);
  layout->setContentsMargins(0, 0, 0, 0);
  auto* line = new QHBoxLayout();
  light_ = new StateLight(head);
  light_->setObjectName("light");
  state_ = new QLabel(head);
  state_->setObjectName("state");
  tracker_edit_ = new QLineEdit(head);
  tracker_edit_->setObjectName("tracker");
  tracker_edit_->setToolTip("Name of the tracker nodelet");
  tracker_edit_->setMaximumWidth(140);
  connect(tracker_edit_, &QLineEdit::editingFinished, this, [this] {
    if (tracker_edit_->text() == tracker_) return;
    setTracker(tracker_edit_->text());
    Q_EMIT configChanged();
  });
  line->addWidget(light_);
  line->addWidget(state_, 1);
  line->addWidget(tracker_edit_);
  reason_ = new QLabel(head);
  reason_->setObjectName("reason");
  reason_->setWordWrap(true);
  reason_->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  reason_->setMinimumHeight(3 * fontMetrics().lineSpacing() + 4);  // so that nothing below jumps
  layout->addLayout(line);
  layout->addWidget(reason_);
  return head;
}

QPushButton* TrackerPanel::makeButton(const char* name, const QString& text, const QString& tip) {
  auto* button = new QPushButton(text, this);
  button->setObjectName(name);
  button->setToolTip(tip);
  return button;
}

QWidget* TrackerPanel::makeButtons() {
  auto* buttons = new QWidget(this);
  auto* layout = new QHBoxLayout(buttons);
  layout->setContentsMargins(0, 0, 0, 0);
  initialise_ =
      makeButton("initialise", "Initialise", "Track from where the blue mesh is: drag it to the object first");
  reset_ = makeButton("reset", "Reset", "Forget the object: the blue mesh appears, to be dragged to it");
  pause_ = makeButton("pause", "Pause", "Stop and go on");
  for (QPushButton* button : {initialise_, reset_, pause_}) layout->addWidget(button);
  const auto name = [this](const char* service) { return tracker_.toStdString() + "/" + service; };
  connect(initialise_, &QPushButton::clicked, this, [this, name] {
    start([service = name("initialize_at_marker")] { return callService(service, std_srvs::Trigger()); });
  });
  connect(reset_, &QPushButton::clicked, this,
          [this, name] { start([service = name("reset")] { return callService(service, std_srvs::Trigger()); }); });
  connect(pause_, &QPushButton::clicked, this, [this, name] {
    std_srvs::SetBool pause;
    pause.request.data = !is_paused_;
    start([service = name("pause"), pause] { return callService(service, pause); });
  });
  return buttons;
}

QWidget* TrackerPanel::makePlots() {
  auto* plots = new QWidget(this);
  auto* layout = new QVBoxLayout(plots);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(4);
  visible_plot_ = new ValuePlot({"visible share", QColor(50, 160, 80), 1.0, -1.0, percent}, plots);
  score_plot_ = new ValuePlot({"score (1 = as the sensor model expects)", QColor(60, 110, 210), 1.2, 1.0,
                               [](double value) { return QString::number(value, 'f', 2); }},
                              plots);
  latency_plot_ = new ValuePlot({"latency", QColor(200, 110, 30), 0.02, 1.0 / 30.0,
                                 [](double value) { return QString::number(1e3 * value, 'f', 1) + " ms"; }},
                                plots);
  for (ValuePlot* plot : {visible_plot_, score_plot_, latency_plot_}) layout->addWidget(plot, 1);
  return plots;
}

void TrackerPanel::setTracker(const QString& name) {
  tracker_ = name.trimmed();
  tracker_edit_->setText(tracker_);
  subscriber_.shutdown();
  showSilence();
  for (ValuePlot* plot : {visible_plot_, score_plot_, latency_plot_}) plot->clear();
  std::string problem;
  if (tracker_.isEmpty() || !ros::names::validate(tracker_.toStdString(), problem)) {
    reason_->setText("'" + tracker_ + "' is no name of a tracker: " + QString::fromStdString(problem));
    return;
  }
  const boost::function<void(const TrackerStatusConstPtr&)> on_status = [this](const TrackerStatusConstPtr& status) {
    QMetaObject::invokeMethod(
        this, [this, status] { showStatus(*status); }, Qt::QueuedConnection);
  };
  subscriber_ = node_.subscribe<TrackerStatus>(tracker_.toStdString() + "/status", 10, on_status);
}

void TrackerPanel::showStatus(const TrackerStatus& status) {
  last_status_at_ = std::chrono::steady_clock::now();
  const StateLook look = lookOf(status);
  light_->setColor(look.color);
  state_->setText("<b>" + QString(look.name) + "</b>&nbsp; " +
                  QString::fromStdString(status.object_name).toHtmlEscaped());
  reason_->setText(QString::fromStdString(status.reason));
  is_paused_ = status.paused;
  pause_->setText(is_paused_ ? "Resume" : "Pause");
  const bool has_estimate = !status.paused && status.state != TrackerStatus::UNINITIALIZED;
  const double gap = std::numeric_limits<double>::quiet_NaN();
  visible_plot_->add(has_estimate ? static_cast<double>(status.visible_fraction) : gap);
  score_plot_->add(has_estimate ? static_cast<double>(status.score) : gap);
  latency_plot_->add(has_estimate ? static_cast<double>(status.latency_s) : gap);
}

void TrackerPanel::showSilence() {
  light_->setColor(QColor(90, 90, 90));
  state_->setText("<b>NO STATUS</b>");
  reason_->setText("nothing on " + tracker_ + "/status: is the tracker running, and is that its name?");
}

void TrackerPanel::start(Call call) {
  if (answer_.valid()) return;
  setButtonsEnabled(false);
  answer_label_->setText("…");
  answer_ = std::async(std::launch::async, std::move(call));
}

void TrackerPanel::lookForAnswer() {
  if (!answer_.valid() || answer_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  answer_label_->setText(QString::fromStdString(answer_.get()));
  setButtonsEnabled(true);
}

void TrackerPanel::setButtonsEnabled(bool enabled) {
  for (QPushButton* button : {initialise_, reset_, pause_}) button->setEnabled(enabled);
}

void TrackerPanel::load(const rviz::Config& config) {
  rviz::Panel::load(config);
  QString name;
  if (config.mapGetString("Tracker", &name)) setTracker(name);
}

void TrackerPanel::save(rviz::Config config) const {
  rviz::Panel::save(config);
  config.mapSetValue("Tracker", tracker_);
}

}  // namespace depth_object_tracker
