// SPDX-License-Identifier: BSD-3-Clause
// An initial pose in any tf frame, taken to the camera's frame.
#pragma once

#include "depth_object_tracker/geometry/pose.h"

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <tf2/buffer_core.h>

#include <string>

namespace depth_object_tracker {

/// A checked initial pose; frame_id empty = the camera's optical frame.
struct InitialPose {
  std::string frame_id;
  ros::Time stamp;  ///< zero = the newest transform
  Pose T_frame_object = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< axes of `frame_id`; all zero = defaults
};

struct CheckedInitialPose {
  InitialPose pose;
  std::string problem;  ///< empty = usable
};

CheckedInitialPose checkInitialPose(const geometry_msgs::PoseWithCovarianceStamped& message);

struct ResolvedPose {
  Pose T_camera_object = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< axes of the camera frame
  std::string problem;                     ///< empty = usable; otherwise both frames, the stamp and what tf says
};

/// For a camera that moves: where it is when the pose is to be used. An object is expected to have rested in the fixed
/// frame since the pose's stamp.
struct MovingCamera {
  std::string fixed_frame;  ///< empty = the camera stands still
  ros::Time image_stamp;
};

/// Never waits: tf that is late is a problem now, which may be gone at the next call.
ResolvedPose resolveInitialPose(const InitialPose& pose, const std::string& camera_frame, const tf2::BufferCore& tf,
                                const MovingCamera& camera = {});

}  // namespace depth_object_tracker
