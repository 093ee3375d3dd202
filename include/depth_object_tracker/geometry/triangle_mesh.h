// SPDX-License-Identifier: BSD-3-Clause
// Triangle mesh of a rigid object, metres, object frame.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

namespace depth_object_tracker {

struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;                ///< [m], object frame
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< vertex indices; any winding
};

struct BoundingBox {
  Eigen::Vector3d min = Eigen::Vector3d::Zero();
  Eigen::Vector3d max = Eigen::Vector3d::Zero();
  Eigen::Vector3d size() const { return max - min; }
};

/// Box of the vertices that triangles use; all zero when there is none.
BoundingBox boundingBox(const TriangleMesh& mesh);

/// Largest distance between two vertices [m]: exact on the vertices that are extreme in at least one of many
/// directions, which is within 1 % of the true diameter.
double diameter(const TriangleMesh& mesh);

/// Area-weighted centroid of the surface [m], object frame: the point that the filter rotates about. It does not depend
/// on how the surface is cut into triangles. Centre of the bounding box when the total area is zero.
Eigen::Vector3d surfaceCentroid(const TriangleMesh& mesh);

/// Removes triangles with out-of-range or repeated indices, non-finite corners or (relative to the mesh) no area.
/// @return number of triangles removed.
std::size_t removeDegenerateTriangles(TriangleMesh& mesh);

}  // namespace depth_object_tracker
