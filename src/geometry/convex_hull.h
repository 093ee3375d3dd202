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

/// @param points of which no three lie on a line and no four in a plane. @return empty for fewer than four.
std::vector<HullFace> convexHull(const std::vector<Eigen::Vector3d>& points);

}  // namespace depth_object_tracker
