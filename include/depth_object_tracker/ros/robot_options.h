// SPDX-License-Identifier: BSD-3-Clause
// The ROS parameters that tell of the robot.
#pragma once

#include "depth_object_tracker/robot/grasp_detector.h"
#include "depth_object_tracker/robot/robot_occluder.h"
#include "depth_object_tracker/ros/robot_connection.h"

#include <ros/node_handle.h>

#include <memory>
#include <string>
#include <vector>

namespace depth_object_tracker {

struct RobotOptions {
  bool enabled = false;          ///< ~robot
  std::string urdf_file;         ///< ~urdf_file; empty = the parameter robot_description, searched upwards
  RobotConnectionConfig config;  ///< ~joint_time_offset_s, ~max_joint_age_s, ~control_source, ~camera_pose_source, ...
  bool use_links_as_occluders = true;   ///< ~robot_occluder
  GraspDetectorConfig grasp_detection;  ///< ~grasp_detection/link, joint, open_position, closed_position, ...
  std::vector<std::string> problems;    ///< one sentence each; empty = all good
};

RobotOptions loadRobotOptions(const ros::NodeHandle& private_node);

/// The robot, or why there is none. Without `enabled` there is neither.
struct BuiltRobot {
  std::shared_ptr<RobotConnection> connection;        ///< null when there is a problem
  std::shared_ptr<GraspDetector> grasp_detector;      ///< null = off
  std::string problem;                                ///< what was read, what is wrong, what to do
  std::shared_ptr<RobotOccluder> occluder = nullptr;  ///< null = off
  std::vector<std::string> warnings = {};             ///< what is left out, one sentence each
};

/// Never throws. @param tf outlives the connection.
BuiltRobot buildRobot(const RobotOptions& options, const ros::NodeHandle& private_node, const tf2::BufferCore& tf);

}  // namespace depth_object_tracker
