// SPDX-License-Identifier: BSD-3-Clause
// A pose with covariance as a user or another node sends it: checked before anything believes it.
#pragma once

#include "depth_object_tracker/geometry/pose.h"

#include <geometry_msgs/PoseWithCovariance.h>

#include <string>

namespace depth_object_tracker {

struct CheckedPose {
  Pose pose = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< all zero = none given
  std::string problem;                     ///< empty = usable; otherwise the field, its value and what is expected
};

/// Refuses numbers that are not finite, quaternions without a direction, negative or inconsistent covariances.
/// Quaternions of another length than 1 are normalised.
CheckedPose checkPose(const geometry_msgs::PoseWithCovariance& message);

/// Axes of a partly given covariance that carry no variance (rviz leaves z, roll and pitch at 0) take the default's.
Matrix6d fillMissingVariances(const Matrix6d& covariance, double position_stddev_m, double rotation_stddev_rad);

}  // namespace depth_object_tracker
