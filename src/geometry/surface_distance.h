// SPDX-License-Identifier: BSD-3-Clause
// Points on a triangle mesh, and the nearest point of a mesh to a given one.
#pragma once

#include "depth_object_tracker/geometry/triangle_mesh.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace depth_object_tracker {

struct SurfacePoint {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();               ///< [m], object frame
  Eigen::Vector3f barycentric = Eigen::Vector3f::Zero();            ///< weights of the triangle's corners, sum 1
  std::uint32_t triangle = 0;                                       ///< index in the mesh
  float squared_distance = std::numeric_limits<float>::infinity();  ///< [m^2], of a nearest-point query
};

/// Normal of a triangle with its area [m^2] as length; outside is where the corners run counter-clockwise.
Eigen::Vector3d areaVector(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle);

/// Nearest-point queries on a mesh: a binary tree of bounding boxes.
class SurfaceTree {
 public:
  /// @param mesh must stay where it is as long as the tree; at least one triangle, valid indices.
  explicit SurfaceTree(const TriangleMesh& mesh);

  /// @param point [m]. @param guess a triangle that is probably near: the result is the same, the search shorter.
  SurfacePoint nearest(const Eigen::Vector3f& point, std::uint32_t guess) const;

  /// Triangle indices so that neighbours in the list are neighbours in space.
  const std::vector<std::uint32_t>& spatialOrder() const { return order_; }

 private:
  using Corners = std::array<Eigen::Vector3f, 3>;
  struct Node {
    Eigen::AlignedBox3f box;
    std::uint32_t begin = 0, end = 0;  // of a leaf, in order_
    std::uint32_t right = 0;           // the left child follows its parent; 0: leaf
  };

  std::uint32_t build(const std::vector<Eigen::Vector3f>& centres, std::uint32_t begin, std::uint32_t end);
  void descend(const Eigen::Vector3f& point, std::uint32_t node_index, SurfacePoint& best) const;

  const TriangleMesh& mesh_;
  std::vector<std::uint32_t> order_;
  std::vector<Corners> corners_;  // of the triangles in order_: side by side in memory
  std::vector<Node> nodes_;
};

/// Points spread evenly over the surface, one at random in each of `count` parts of equal area; neighbours in the list
/// are neighbours in space. Fewer (none) when the surface has no area.
/// @param tree of this mesh.
std::vector<SurfacePoint> samplePoints(const TriangleMesh& mesh, const SurfaceTree& tree, std::size_t count,
                                       std::uint32_t seed);

}  // namespace depth_object_tracker
