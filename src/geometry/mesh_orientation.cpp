// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/geometry/mesh_orientation.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <numeric>
#include <utility>

namespace depth_object_tracker {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
using DirectedEdge = std::pair<std::uint32_t, std::uint32_t>;

/// Every directed edge as often as its reverse: the surface has no border, so a line enters as often as it leaves.
bool isClosedAndConsistent(const std::vector<Triangle>& triangles) {
  std::vector<DirectedEdge> edges, reversed;
  edges.reserve(3 * triangles.size());
  reversed.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      edges.emplace_back(t[k], t[(k + 1) % 3]);
      reversed.emplace_back(t[(k + 1) % 3], t[k]);
    }
  }
  std::sort(edges.begin(), edges.end());
  std::sort(reversed.begin(), reversed.end());
  return edges == reversed;
}

/// Union-find over vertices: the root of a triangle's first corner names its component.
class Components {
 public:
  explicit Components(std::size_t num_vertices) : parent_(num_vertices) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t root(std::uint32_t vertex) {
    while (parent_[vertex] != vertex) vertex = parent_[vertex] = parent_[parent_[vertex]];
    return vertex;
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[root(a)] = root(b); }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace

bool orientOutward(const TriangleMesh& mesh, std::vector<Triangle>& triangles) {
  if (triangles.empty() || !isClosedAndConsistent(triangles)) return false;
  Components components(mesh.vertices.size());
  for (const Triangle& t : triangles) {
    components.join(t[0], t[1]);
    components.join(t[1], t[2]);
  }
  // Six times the signed volume of each component: positive when counter-clockwise from outside.
  std::vector<double> volume(mesh.vertices.size(), 0.0);
  for (const Triangle& t : triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>(), b = mesh.vertices[t[1]].cast<double>();
    volume[components.root(t[0])] += a.dot(b.cross(mesh.vertices[t[2]].cast<double>()));
  }
  for (Triangle& t : triangles) {
    if (volume[components.root(t[0])] < 0.0) std::swap(t[1], t[2]);
  }
  return true;
}

}  // namespace depth_object_tracker
