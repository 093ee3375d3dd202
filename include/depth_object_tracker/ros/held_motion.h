// SPDX-License-Identifier: BSD-3-Clause
// Whether a robot holds the object, and how it moves it: by the joints of a link, or as control_twist says.
#pragma once

#include "depth_object_tracker/model/control_input.h"
#include "depth_object_tracker/robot/twist_buffer.h"
#include "depth_object_tracker/ros/robot_options.h"

#include <geometry_msgs/TwistStamped.h>
#include <tf2/buffer_core.h>

#include <optional>
#include <string>

namespace depth_object_tracker {

/// What is held, and why its motion is unknown where it is.
struct HeldControl {
  std::optional<ControlInput> control;  ///< nullopt = not held
  std::string problem;
};

/// Not thread-safe.
class HeldMotion {
 public:
  /// Without this, or with its problem, links cannot be followed.
  void setRobot(BuiltRobot robot) { robot_ = std::move(robot); }
  RobotConnection* robot() const { return robot_.connection.get(); }
  RobotOccluder* occluder() const { return robot_.occluder.get(); }
  GraspDetector* graspDetector() const { return robot_.grasp_detector.get(); }

  /// @return empty, or why the motion of what this link holds cannot be known.
  std::string findLinkProblem(const std::string& link) const;

  /// @param link empty = control_twist tells the motion. One with a problem: held, but the motion is unknown.
  void setGrasp(bool grasped, const std::string& link);

  /// Keeps the twist, turned to the axes of the camera; its frame must not move against the camera.
  /// @param camera_frame empty, or an empty frame_id: the axes are taken to be the camera's.
  /// @return empty, or why the twist is ignored.
  std::string addTwist(const geometry_msgs::TwistStamped& twist, const std::string& camera_frame,
                       const tf2::BufferCore& tf);

  /// True when the twist or the joints up to this stamp are not here yet but may well come.
  bool awaitsControl(double stamp_s, const std::string& camera_frame) const;

  /// Mean motion over (from_s, to_s]; marked as unknown where nothing covers it.
  /// @param T_camera_object where the object was at from_s. @param T_now_before as RobotConnection::control.
  HeldControl control(double from_s, double to_s, const std::string& camera_frame, const Pose& T_camera_object,
                      const Pose& T_now_before) const;

  /// Time jumped: what came before means nothing any more.
  void forget();

  bool isGrasped() const { return grasped_; }
  const std::string& link() const { return link_; }
  bool followsLink() const { return grasped_ && !link_.empty() && link_problem_.empty(); }

 private:
  bool followsTwist() const { return grasped_ && link_.empty(); }

  bool grasped_ = false;
  std::string link_;
  std::string link_problem_;
  TwistBuffer twists_;
  BuiltRobot robot_;
};

}  // namespace depth_object_tracker
