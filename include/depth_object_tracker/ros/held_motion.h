// SPDX-License-Identifier: BSD-3-Clause
// Whether a robot holds the object, and how it moves it according to control_twist.
#pragma once

#include "depth_object_tracker/model/control_input.h"
#include "depth_object_tracker/robot/twist_buffer.h"

#include <geometry_msgs/TwistStamped.h>
#include <tf2/buffer_core.h>

#include <optional>
#include <string>

namespace depth_object_tracker {

/// Not thread-safe.
class HeldMotion {
 public:
  /// @param link empty = control_twist tells the motion; otherwise it is unknown (no kinematics yet).
  void setGrasp(bool grasped, const std::string& link);

  /// Keeps the twist, turned to the axes of the camera; its frame must not move against the camera.
  /// @param camera_frame empty, or an empty frame_id: the axes are taken to be the camera's.
  /// @return empty, or why the twist is ignored.
  std::string addTwist(const geometry_msgs::TwistStamped& twist, const std::string& camera_frame,
                       const tf2::BufferCore& tf);

  /// True when the twist up to this stamp is not here yet but may well come.
  bool awaitsTwist(double stamp_s) const;

  /// nullopt = not held. Without a twist that covers (from_s, to_s] the motion is marked as unknown.
  std::optional<ControlInput> control(double from_s, double to_s) const;

  /// Time jumped: what was commanded before means nothing any more.
  void forgetTwists() { twists_.clear(); }

  bool isGrasped() const { return grasped_; }
  bool followsTwist() const { return grasped_ && link_.empty(); }

 private:
  bool grasped_ = false;
  std::string link_;
  TwistBuffer twists_;
};

}  // namespace depth_object_tracker
