// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/initial_pose_resolver.h"

#include "depth_object_tracker/ros/message_conversions.h"
#include "depth_object_tracker/ros/pose_validation.h"

#include <tf2/exceptions.h>

#include <sstream>

namespace depth_object_tracker {

CheckedInitialPose checkInitialPose(const geometry_msgs::PoseWithCovarianceStamped& message) {
  CheckedInitialPose checked;
  const CheckedPose pose = checkPose(message.pose);
  checked.problem = pose.problem;
  const std::string& frame = message.header.frame_id;
  checked.pose.frame_id = !frame.empty() && frame.front() == '/' ? frame.substr(1) : frame;
  checked.pose.stamp = message.header.stamp;
  checked.pose.T_frame_object = pose.pose;
  checked.pose.covariance = pose.covariance;
  return checked;
}

ResolvedPose resolveInitialPose(const InitialPose& pose, const std::string& camera_frame, const tf2::BufferCore& tf,
                                const MovingCamera& camera) {
  ResolvedPose resolved;
  resolved.T_camera_object = pose.T_frame_object;
  resolved.covariance = pose.covariance;
  const std::string& frame = pose.frame_id.empty() ? camera_frame : pose.frame_id;
  const bool has_moved = !camera.fixed_frame.empty() && !pose.stamp.isZero() && pose.stamp != camera.image_stamp;
  if (frame == camera_frame && !has_moved) return resolved;
  try {
    const auto transform =
        has_moved
            ? tf.lookupTransform(camera_frame, camera.image_stamp, frame, pose.stamp, camera.fixed_frame)
            : tf.lookupTransform(camera_frame, frame, camera.fixed_frame.empty() ? pose.stamp : camera.image_stamp);
    const Pose T_camera_frame = fromTransformMessage(transform.transform);
    resolved.T_camera_object = T_camera_frame * pose.T_frame_object;
    resolved.covariance = rotated(pose.covariance, T_camera_frame.linear());
  } catch (const tf2::TransformException& error) {
    std::ostringstream problem;
    problem << "the initial pose is given in frame '" << frame << "' at stamp " << pose.stamp
            << ", which tf cannot take to the camera's frame '" << camera_frame << "': " << error.what();
    resolved.problem = problem.str();
  }
  return resolved;
}

}  // namespace depth_object_tracker
