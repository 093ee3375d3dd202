// SPDX-License-Identifier: BSD-3-Clause
// The object's pose from its fiducials' places: least squares.
#pragma once

#include "depth_object_tracker/fiducials/fiducial_points.h"

#include <optional>
#include <vector>

namespace depth_object_tracker {

struct FiducialPose {
  Pose T_camera_object = Pose::Identity();
  Matrix6d covariance = Matrix6d::Identity();  ///< of the mesh origin's pose
  int num_tags = 0;
  double rms_m = 0.0;  ///< of the points' residuals
};

/// Least squares over the points (Umeyama's closed form), refined with their covariances. The tag that fits worst is
/// left out for as long as the residual is larger than `max_rms_m` and other tags remain.
/// @return nullopt when fewer than three points remain, they lie on a line, or they do not fit one pose.
std::optional<FiducialPose> fitFiducialPose(std::vector<FiducialPoint> points, double max_rms_m = 0.01);

}  // namespace depth_object_tracker
