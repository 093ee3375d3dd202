// SPDX-License-Identifier: BSD-3-Clause
// The large planes of a depth image: tables, walls, floors.
#pragma once

#include "depth_object_tracker/geometry/depth_image.h"
#include "depth_object_tracker/geometry/pinhole_camera.h"

#include <Eigen/Core>

#include <vector>

namespace depth_object_tracker {

/// normal . p = offset_m for the points p on it, optical frame.
struct ImagePlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit length, towards the camera
  double offset_m = 0.0;                              ///< <= 0: the camera is above it
  double share = 0.0;                                 ///< of the image's readings that lie on it
  std::vector<Eigen::Vector3d> points;                ///< [m] some of these readings, evenly over the image

  double heightOf(const Eigen::Vector3d& p_camera) const { return normal.dot(p_camera) - offset_m; }
};

/// Within so much of a plane a reading at depth z [m] lies on it [m].
double planeToleranceM(double z);

/// @param max_depth_m readings beyond are left out. @return the largest first; none below 2 % of the readings. The same
/// image gives the same planes.
std::vector<ImagePlane> findPlanes(const DepthImageView& depth, const PinholeCamera& camera, double max_depth_m);

}  // namespace depth_object_tracker
