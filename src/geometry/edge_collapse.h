// SPDX-License-Identifier: BSD-3-Clause
// Fewer triangles for about the same surface, by collapsing edges (Garland and Heckbert, SIGGRAPH 1997).
#pragma once

#include "depth_object_tracker/geometry/triangle_mesh.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <queue>
#include <tuple>
#include <vector>

namespace depth_object_tracker {

/// Weighted sum of squared distances from planes, as a function of the point.
struct PlaneQuadric {
  Eigen::Matrix3d normals = Eigen::Matrix3d::Zero();  ///< sum of weight * n n^T
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();   ///< sum of weight * n (n . p)
  double constant = 0.0;                              ///< sum of weight * (n . p)^2

  /// @param normal unit length. @param point on the plane [m]. @param weight [m^2].
  void addPlane(const Eigen::Vector3d& normal, const Eigen::Vector3d& point, double weight);
  PlaneQuadric& operator+=(const PlaneQuadric& other);
  double at(const Eigen::Vector3d& point) const;
  /// Where it is least; where the planes leave the point free, as near as possible to `start`.
  Eigen::Vector3d minimum(const Eigen::Vector3d& start) const;
};

/// Collapses the edges of a mesh one by one, least damage first.
class EdgeCollapser {
 public:
  enum class Topology {
    kKept,  ///< a closed manifold stays one; no hole is closed, no loose piece vanishes, so that it may end early
    kFree,  ///< pieces may touch, merge and vanish; a loose triangle stays
  };

  /// @param mesh welded, with valid triangles only.
  explicit EdgeCollapser(const TriangleMesh& mesh);

  /// Collapses until at most so many triangles are left, or no edge can be collapsed without a fold (or, where it is to
  /// be kept, a change of topology). Directed edges that cancelled before still do.
  void reduceTo(std::size_t target_triangles, Topology topology);

  std::size_t numTriangles() const { return num_triangles_; }

  /// The mesh as it is now; no unused vertices.
  TriangleMesh mesh() const;

 private:
  using Triangle = std::array<std::uint32_t, 3>;
  struct Edge {
    double cost;  // [m^4]: squared distances times area
    std::uint32_t low, high, low_version, high_version;
    bool operator<(const Edge& other) const {  // the cheapest on top of the queue; ties in a fixed order
      return std::tie(other.cost, other.low, other.high) < std::tie(cost, low, high);
    }
  };

  void addPlanes();
  void addBorder(std::uint32_t i, std::uint32_t j, const Eigen::Vector3d& normal);
  void pushEdge(std::uint32_t i, std::uint32_t j);
  Eigen::Vector3d mergedPosition(std::uint32_t i, std::uint32_t j) const;
  bool keepsTopology(std::uint32_t i, std::uint32_t j) const;
  bool folds(std::uint32_t moved, std::uint32_t other, const Eigen::Vector3d& position) const;
  void collapse(std::uint32_t kept, std::uint32_t removed, const Eigen::Vector3d& position);
  std::vector<std::uint32_t> neighbours(std::uint32_t i) const;

  std::vector<Eigen::Vector3d> positions_;
  std::vector<Triangle> triangles_;  // a removed one has all corners equal
  std::vector<std::vector<std::uint32_t>> triangles_of_;
  std::vector<PlaneQuadric> quadrics_;
  std::vector<std::uint32_t> version_;  // of a vertex: edges queued before it moved are out of date
  std::vector<bool> is_border_;         // has an edge of one triangle, or of more than two
  std::priority_queue<Edge> queue_;
  std::size_t num_triangles_ = 0;
};

}  // namespace depth_object_tracker
