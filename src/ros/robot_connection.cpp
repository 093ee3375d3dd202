// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/robot_connection.h"

#include "depth_object_tracker/robot/hand_motion.h"
#include "depth_object_tracker/ros/message_conversions.h"

#include <ros/time.h>
#include <tf2/exceptions.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace depth_object_tracker {
namespace {

JointReport toReport(const sensor_msgs::JointState& message, bool with_positions) {
  JointReport report;
  report.stamp_s = message.header.stamp.toSec();
  report.names = message.name;
  if (with_positions) report.positions = message.position;
  report.velocities = message.velocity;
  return report;
}

std::string ignored(const char* topic, const std::string& problem) {
  return problem.empty() ? "" : std::string(topic) + ": a message is ignored where it is wrong: " + problem;
}

}  // namespace

RobotConnection::RobotConnection(RobotModel model, const RobotConnectionConfig& config, const tf2::BufferCore& tf)
    : state_(std::move(model), config.state), config_(config), tf_(tf) {}

std::string RobotConnection::addJointStates(const sensor_msgs::JointState& message) {
  return ignored("joint_states", state_.addJointStates(toReport(message, true)));
}

std::string RobotConnection::addCommands(const sensor_msgs::JointState& message) {
  return ignored("joint_commands", state_.addCommands(toReport(message, false)));
}

std::string RobotConnection::findLinkProblem(const std::string& link) const {
  if (model().hasLink(link)) return "";
  try {
    model().chainTo(link);
  } catch (const RobotModelError& error) {
    return error.what();
  }
  return "";
}

const std::string& RobotConnection::baseFrame() const {
  return config_.base_frame.empty() ? model().rootLink() : config_.base_frame;
}

LinkInCamera RobotConnection::locateRoot(const std::string& camera_frame, double stamp_s) {
  LinkInCamera located;
  if (config_.camera_pose_source == CameraPoseSource::kUrdf) {
    located.problem = findLinkProblem(camera_frame);
    if (!located.problem.empty()) {
      located.problem = "~camera_pose_source is urdf, but " + located.problem;
      return located;
    }
    const LinkPose camera = state_.linkPose(camera_frame, stamp_s);
    located.problem = camera.problem;
    located.T_camera_link = camera.T_root_link.inverse();
    return located;
  }
  try {
    // A camera that moves is moved by the robot: its tf keeps the joints' clock.
    const ros::Time time(stamp_s + config_.state.joint_time_offset_s);
    located.T_camera_link = fromTransformMessage(tf_.lookupTransform(camera_frame, baseFrame(), time).transform);
  } catch (const std::exception& error) {
    located.problem = "tf does not know the robot's base '" + baseFrame() + "' in the camera's frame '" + camera_frame +
                      "' at the time of the image: " + error.what();
  }
  return located;
}

LinkInCamera RobotConnection::locate(const std::string& link, const std::string& camera_frame, double stamp_s) {
  LinkInCamera located = locateRoot(camera_frame, stamp_s);
  if (!located.problem.empty()) return located;
  const LinkPose pose = state_.linkPose(link, stamp_s);
  located.problem = pose.problem;
  located.T_camera_link = located.T_camera_link * pose.T_root_link;
  return located;
}

HandControl RobotConnection::control(const std::string& link, const std::string& camera_frame, double from_s,
                                     double to_s, const Pose& T_camera_object, const Pose& T_now_before) {
  HandControl result;
  result.control.grasped = true;
  result.control.has_twist = false;
  const LinkMotion motion = state_.linkMotion(link, from_s, to_s);
  result.problem = motion.problem;
  if (!result.problem.empty()) return result;
  const LinkInCamera root_from = locateRoot(camera_frame, from_s), root_to = locateRoot(camera_frame, to_s);
  result.problem = !root_from.problem.empty() ? root_from.problem : root_to.problem;
  if (!result.problem.empty()) return result;
  result.control =
      carryWithHand(T_now_before * root_from.T_camera_link * motion.T_root_link_from,
                    root_to.T_camera_link * motion.T_root_link_to, T_now_before * T_camera_object, to_s - from_s);
  return result;
}

bool RobotConnection::awaits(const std::string& link, const std::string& camera_frame, double stamp_s) {
  if (camera_frame.empty()) return false;  // no image yet
  if (state_.awaitsJoints(link, stamp_s)) return true;
  if (config_.camera_pose_source == CameraPoseSource::kUrdf) {
    return model().hasLink(camera_frame) && state_.awaitsJoints(camera_frame, stamp_s);
  }
  const ros::Time time(std::max(0.0, stamp_s + config_.state.joint_time_offset_s));  // simulated time begins at 0
  return !tf_.canTransform(camera_frame, baseFrame(), time) &&
         tf_.canTransform(camera_frame, baseFrame(), ros::Time(0));
}

CameraPoseSource cameraPoseSourceFromName(const std::string& name) {
  if (name == "tf") return CameraPoseSource::kTf;
  if (name == "urdf") return CameraPoseSource::kUrdf;
  throw std::invalid_argument("camera_pose_source is '" + name + "', must be one of: tf, urdf");
}

}  // namespace depth_object_tracker
