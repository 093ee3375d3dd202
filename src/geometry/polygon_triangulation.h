// SPDX-License-Identifier: BSD-3-Clause
// Cuts the polygons of mesh files into triangles. (assimp's own step aborts the process on faces without corners.)
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace depth_object_tracker {

/// Larger polygons are refused: cutting takes up to the cube of the number of corners.
constexpr std::size_t kMaxPolygonCorners = 1000;

/// Triangles of a flat or nearly flat polygon as positions in `corners`; concave ones are cut correctly, self-crossing
/// ones somehow. Corners must be finite. Fewer than three corners give none.
std::vector<std::array<std::size_t, 3>> triangulatePolygon(const std::vector<Eigen::Vector3d>& corners);

}  // namespace depth_object_tracker
