// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/pose_messages.h"

#include "depth_object_tracker/ros/message_conversions.h"

namespace depth_object_tracker {

bool hasPoseToTell(const TrackerResult& result) {
  return result.has_pose && result.state != TrackerState::kLost && result.state != TrackerState::kUninitialized &&
         isValidPose(result.T_camera_object) && result.covariance.allFinite();
}

bool hasTwistToTell(const TrackerResult& result) {
  return result.twist.allFinite() && result.twist_covariance.allFinite();
}

geometry_msgs::PoseWithCovarianceStamped toPoseStamped(const TrackerResult& result, const std_msgs::Header& header) {
  geometry_msgs::PoseWithCovarianceStamped message;
  message.header = header;
  message.pose = toPoseMessage(result.T_camera_object, result.covariance);
  return message;
}

geometry_msgs::TwistWithCovarianceStamped toTwistStamped(const TrackerResult& result, const std_msgs::Header& header) {
  geometry_msgs::TwistWithCovarianceStamped message;
  message.header = header;
  message.twist = toTwistMessage(result.twist, result.twist_covariance);
  return message;
}

geometry_msgs::TransformStamped toTransformStamped(const TrackerResult& result, const std_msgs::Header& header,
                                                   const std::string& child_frame) {
  geometry_msgs::TransformStamped message;
  message.header = header;
  message.child_frame_id = child_frame;
  message.transform = toTransformMessage(result.T_camera_object);
  return message;
}

}  // namespace depth_object_tracker
