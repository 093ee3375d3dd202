// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/geometry/mesh_orientation.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <utility>

namespace depth_object_tracker {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// Union-find over triangles. Parts that merely touch (in a corner, or in an edge of more than two triangles) stay
/// apart: each may have a winding of its own.
class Components {
 public:
  explicit Components(const std::vector<Triangle>& triangles) : parent_(triangles.size()) {
    std::iota(parent_.begin(), parent_.end(), 0u);
    std::vector<std::array<std::uint32_t, 3>> edges;  // lower vertex, higher vertex, triangle
    edges.reserve(3 * triangles.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax(triangles[i][k], triangles[i][(k + 1) % 3]);
        edges.push_back({low, high, i});
      }
    }
    std::sort(edges.begin(), edges.end());
    const auto same_edge = [&](std::size_t i, std::size_t j) {
      return j < edges.size() && edges[i][0] == edges[j][0] && edges[i][1] == edges[j][1];
    };
    for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
      for (end = i + 1; same_edge(i, end);) ++end;
      if (end - i == 2) parent_[root(edges[i][2])] = root(edges[i + 1][2]);
    }
  }
  std::uint32_t root(std::uint32_t triangle) {
    while (parent_[triangle] != triangle) triangle = parent_[triangle] = parent_[parent_[triangle]];
    return triangle;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// In every component each directed edge as often as its reverse: it has no border, so a line enters as often as it
/// leaves.
bool areClosedAndConsistent(const std::vector<Triangle>& triangles, Components& components) {
  std::vector<std::array<std::uint32_t, 3>> edges, reversed;  // component, from, to
  edges.reserve(3 * triangles.size());
  reversed.reserve(3 * triangles.size());
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[i];
    for (std::size_t k = 0; k < 3; ++k) {
      edges.push_back({components.root(i), t[k], t[(k + 1) % 3]});
      reversed.push_back({components.root(i), t[(k + 1) % 3], t[k]});
    }
  }
  std::sort(edges.begin(), edges.end());
  std::sort(reversed.begin(), reversed.end());
  return edges == reversed;
}

}  // namespace

bool orientOutward(const TriangleMesh& mesh, std::vector<Triangle>& triangles) {
  if (triangles.empty()) return false;
  Components components(triangles);
  if (!areClosedAndConsistent(triangles, components)) return false;
  // Six times the signed volume of each component: positive when counter-clockwise from outside.
  std::vector<double> volume(triangles.size(), 0.0);
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[i];
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>(), b = mesh.vertices[t[1]].cast<double>();
    volume[components.root(i)] += a.dot(b.cross(mesh.vertices[t[2]].cast<double>()));
  }
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    if (volume[components.root(i)] < 0.0) std::swap(triangles[i][1], triangles[i][2]);
  }
  return true;
}

}  // namespace depth_object_tracker
