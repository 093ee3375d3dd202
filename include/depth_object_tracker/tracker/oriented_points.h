// SPDX-License-Identifier: BSD-3-Clause
// Points of surfaces with their normals, of a depth image and of an object: one of each, laid on one another, are a
// pose up to a turn about the normal.
#pragma once

#include "depth_object_tracker/geometry/depth_image.h"
#include "depth_object_tracker/geometry/pinhole_camera.h"
#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/geometry/triangle_mesh.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace depth_object_tracker {

struct OrientedPoint {
  Eigen::Vector3d point;   ///< [m]
  Eigen::Vector3d normal;  ///< unit length, out of the surface
};

/// Plane fitted to the readings within `reach_m` of a pixel's beam and depth.
/// @return nullopt where there are too few readings, or they are no smooth surface.
std::optional<OrientedPoint> orientedPointAt(const DepthImageView& depth, const PinholeCamera& camera, int row, int col,
                                             double reach_m);

/// Points of a depth image, optical frame, where an object may be seen: not on planes that go on beyond it.
/// @param object_diameter_m > 0. @param reach_m of the patches that the normals are from. @param max_depth_m readings
/// beyond are left out. @param step_px >= 1, of the grid of pixels that are looked at.
std::vector<OrientedPoint> imagePoints(const DepthImageView& depth, const PinholeCamera& camera,
                                       double object_diameter_m, double reach_m, double max_depth_m, int step_px);

/// The same, on large planes too. @param reach_m of the patches that the normals are from.
std::vector<OrientedPoint> allImagePoints(const DepthImageView& depth, const PinholeCamera& camera, double reach_m,
                                          double max_depth_m, int step_px);

/// Points all over the surface that can be seen from outside, from `centre_object`, object axes.
std::vector<OrientedPoint> objectPoints(const TriangleMesh& mesh, const Eigen::Vector3d& centre_object);

/// Size of an object's parts [m]: its diameter when it is compact, less when it is thin.
double featureSize(const TriangleMesh& mesh, double diameter_m);

/// Of the plane patches above, as a share of the feature size.
constexpr double kPatchReachPerSize = 0.07;

/// T_camera_centre that lays the object's point on the image's, normal on normal. @param turn_rad about the normal.
Pose layOn(const OrientedPoint& image_point, const OrientedPoint& object_point, double turn_rad);

/// Rotation `index` of an endless sequence that covers all rotations evenly, however many are taken.
Eigen::Matrix3d evenlySpreadRotation(std::size_t index);

}  // namespace depth_object_tracker
