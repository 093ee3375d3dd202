// SPDX-License-Identifier: BSD-3-Clause
// Convex hull of a few hundred points.
#pragma once

#include <Eigen/Core>

#include <array>
#include <vector>

namespace depth_object_tracker {

struct HullFace {
  std::array<int, 3> corners;  ///< indices of the points, counter-clockwise seen from outside
  Eigen::Vector3d normal;      ///< outwards, unit length
};

/// Empty when all points lie in a plane. Points nearer to the hull than `tolerance_m` may be left out of it.
std::vector<HullFace> convexHull(const std::vector<Eigen::Vector3d>& points, double tolerance_m);

}  // namespace depth_object_tracker
