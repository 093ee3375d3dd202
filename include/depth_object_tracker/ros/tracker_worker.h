// SPDX-License-Identifier: BSD-3-Clause
// The tracker's thread: takes commands and the newest image from the inbox, runs the session, publishes.
#pragma once

#include "depth_object_tracker/ros/drop_watch.h"
#include "depth_object_tracker/ros/result_publisher.h"
#include "depth_object_tracker/ros/status_builder.h"
#include "depth_object_tracker/ros/tracker_diagnostics.h"
#include "depth_object_tracker/ros/tracker_session.h"

#include <functional>
#include <string>
#include <thread>

namespace depth_object_tracker {

/// Session and publisher belong to the worker's thread from start() to stop(); others reach them through post().
class TrackerWorker {
 public:
  using SessionCommand = std::function<void(TrackerSession&)>;

  TrackerWorker(const std::string& name, TrackerSession session, ResultPublisher publisher, double control_wait_s);
  ~TrackerWorker();

  /// Who looks on after each status, on the worker's thread. Before start().
  using Observer = std::function<void(const DiagnosticSnapshot&, const TrackerSession&)>;
  void setObserver(Observer observer) { observer_ = std::move(observer); }

  void start();

  /// Waits for the image in work; answers whoever waits for an initialisation. Called twice it does nothing.
  void stop();

  /// The newest image wins.
  void postFrame(CameraFrame frame) { inbox_.postFrame(std::move(frame)); }

  /// Carried out before the next image. @param announce publish the status afterwards.
  /// @return false when the worker has stopped.
  bool post(SessionCommand command, bool announce = true);

  bool postTracker(BuiltTracker built);

 private:
  using Clock = std::chrono::steady_clock;

  void run();
  void carryOut(std::deque<FrameInbox::Command>& commands);
  void handleFrame(const CameraFrame& frame);
  void waitForControl(const CameraFrame& frame);
  void reportIdle();
  void watchStamp(const ros::Time& stamp);
  void tellObserver(const TrackerStatus& status) const;
  void publishStatus(const TrackerResult& result);

  ThrottledLog log_;
  TrackerSession session_;
  ResultPublisher publisher_;
  std::chrono::duration<double> control_wait_;
  FrameInbox inbox_;
  FrameStatistics statistics_;
  DropWatch drop_watch_;
  Observer observer_;
  std::optional<double> stamp_age_s_;
  bool stamp_problem_told_ = false;
  Clock::time_point last_image_at_ = Clock::now();
  Clock::time_point last_status_at_ = Clock::now();
  bool announce_ = false;       // a command asked for a status
  bool idle_reported_ = false;  // in the log, once for as long as no image comes
  std::thread thread_;
};

}  // namespace depth_object_tracker
