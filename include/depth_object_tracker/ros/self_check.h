// SPDX-License-Identifier: BSD-3-Clause
// Looks for mistakes of the set-up in the first images, and now and then later; remembers what it found.
#pragma once

#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/ros/frame_inbox.h"
#include "depth_object_tracker/tracker/input_check.h"
#include "depth_object_tracker/tracker/object_tracker.h"

#include <tf2/buffer_core.h>

#include <chrono>
#include <string>
#include <vector>

namespace depth_object_tracker {

/// Sentences name the topic that they are about. Not thread-safe.
class SelfCheck {
 public:
  SelfCheck(std::string image_topic, std::string info_topic)
      : image_topic_(std::move(image_topic)), info_topic_(std::move(info_topic)) {}

  /// Another object or camera: everything is looked at anew.
  void restart();

  /// Looks at the first images, then at one a second. @param tracker may be null.
  /// @return true when it looked.
  bool look(const CameraFrame& frame, const DepthImageView& depth, const PinholeCamera& camera,
            const ObjectTracker* tracker);

  /// Looks at a new initial pose once; what was said about the one before is forgotten.
  void lookAtPose(const Pose& T_camera_object, const DepthImageView& depth, const PinholeCamera& camera,
                  const ObjectTracker& tracker);

  /// The object was found: the initial pose was good enough.
  void forgetPose() { pose_findings_.clear(); }

  /// What was found last, one sentence each; empty = nothing is suspicious.
  std::vector<std::string> findings() const;

 private:
  using Clock = std::chrono::steady_clock;

  std::string image_topic_, info_topic_;
  int num_looks_ = 0;
  Clock::time_point last_look_;
  bool mesh_is_odd_ = false;
  std::vector<std::string> input_findings_, pose_findings_;
};

/// What to say when the camera's frame hangs in the air: nothing, "" when tf connects it to a parent.
std::string describeMissingParent(const std::string& camera_frame, const tf2::BufferCore& tf);

}  // namespace depth_object_tracker
