// SPDX-License-Identifier: BSD-3-Clause
// The tracker nodelet's session, fed by the messages of a bag.
#pragma once

#include "depth_object_tracker/ros/tracker_session.h"

#include <rosbag/message_instance.h>
#include <tf2/buffer_core.h>

#include <deque>
#include <functional>
#include <string>

namespace depth_object_tracker {

class BagRecording;

/// What comes with a stamp of its own (tf, joints, twists) is known a little before the image that it belongs to is
/// tracked, as the nodelet would wait for it; images and grasps keep the order of their recording. The clock of the
/// machine plays no part.
class BagTracker {
 public:
  static constexpr double kLookAheadS = 0.25;

  /// Called for every image, also for those that cannot be used.
  using Output = std::function<void(const FrameOutcome& outcome, const ros::Time& recorded_at)>;

  BagTracker(const BagRecording& recording, Output output);

  TrackerSession& session() { return session_; }
  const tf2::BufferCore& tf() const { return tf_; }

  void run();

 private:
  struct Waiting {
    ros::Time recorded_at;
    rosbag::MessageInstance message;
  };
  bool takeAtOnce(const rosbag::MessageInstance& message);
  void takeTransforms(const rosbag::MessageInstance& message, bool is_static);
  void takeWaiting(const rosbag::MessageInstance& message);
  void takeWaitingBefore(const ros::Time& time);

  const BagRecording& recording_;
  Output output_;
  tf2::BufferCore tf_;
  TrackerSession session_;
  std::deque<Waiting> waiting_;
};

}  // namespace depth_object_tracker
