// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark_object.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace depth_object_tracker {
namespace {

/// Point of the body's surface in a direction.
Eigen::Vector3f bodySurface(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d d = direction.normalized();
  const double lumps =
      1.0 + 0.10 * std::sin(4.0 * d.x() + 1.0) * std::cos(3.0 * d.y()) + 0.07 * std::sin(5.0 * d.z() + 2.0 * d.x());
  return (lumps * d.cwiseProduct(Eigen::Vector3d(0.045, 0.040, 0.060))).cast<float>();
}

/// A cube's surface of 12 cells^2 triangles, blown up: all of about the same size, no poles.
class BodyBuilder {
 public:
  BodyBuilder(int cells, TriangleMesh& mesh) : cells_(cells), mesh_(mesh) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      addSide(axis, 0);
      addSide(axis, cells);
    }
  }

 private:
  using Node = std::array<int, 3>;

  void addSide(std::size_t axis, int level) {
    for (int i = 0; i < cells_; ++i) {
      for (int j = 0; j < cells_; ++j) {
        const auto corner = [&](int di, int dj) {
          Node node;
          node[axis] = level;
          node[(axis + 1) % 3] = i + di;
          node[(axis + 2) % 3] = j + dj;
          return vertex(node);
        };
        const std::uint32_t a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
        addTriangle(a, b, c, level == 0);
        addTriangle(a, c, d, level == 0);
      }
    }
  }

  void addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, bool turned) {
    if (turned) std::swap(b, c);
    mesh_.triangles.push_back({a, b, c});
  }

  /// Sides share the vertices of their edges, so that the surface is closed.
  std::uint32_t vertex(const Node& node) {
    const auto [entry, is_new] = vertices_.emplace(node, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (is_new) {
      Eigen::Vector3d direction;
      for (int k = 0; k < 3; ++k) {
        direction[k] = std::tan(M_PI_4 * (2.0 * node[static_cast<std::size_t>(k)] / cells_ - 1.0));
      }
      mesh_.vertices.push_back(bodySurface(direction));
    }
    return entry->second;
  }

  int cells_;
  TriangleMesh& mesh_;
  std::map<Node, std::uint32_t> vertices_;
};

/// A ring of 2 around * along triangles, half of it inside of the body.
void addHandle(int around, int along, TriangleMesh& mesh) {
  constexpr double kRingRadius = 0.034, kTubeRadius = 0.008, kOffset = 0.045;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < along; ++i) {
    const double theta = 2.0 * M_PI * i / along;
    for (int j = 0; j < around; ++j) {
      const double phi = 2.0 * M_PI * j / around, radius = kRingRadius + kTubeRadius * std::cos(phi);
      mesh.vertices.push_back(
          Eigen::Vector3d(kOffset + radius * std::cos(theta), kTubeRadius * std::sin(phi), radius * std::sin(theta))
              .cast<float>());
    }
  }
  const auto vertex = [&](int i, int j) { return first + static_cast<std::uint32_t>(i % along * around + j % around); };
  for (int i = 0; i < along; ++i) {
    for (int j = 0; j < around; ++j) {
      mesh.triangles.push_back({vertex(i, j), vertex(i, j + 1), vertex(i + 1, j + 1)});
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i + 1, j)});
    }
  }
}

}  // namespace

TriangleMesh makeBenchmarkObject(int num_triangles) {
  constexpr double kBodyShare = 0.8;
  constexpr double kAlongPerAround = 3.0;  // the handle's triangles have about the same size as the body's
  TriangleMesh mesh;
  BodyBuilder(static_cast<int>(std::lround(std::sqrt(kBodyShare * num_triangles / 12.0))), mesh);
  const double pairs_left = 0.5 * (num_triangles - static_cast<double>(mesh.triangles.size()));
  const int around = std::max(3, static_cast<int>(std::lround(std::sqrt(pairs_left / kAlongPerAround))));
  addHandle(around, std::max(5, static_cast<int>(std::lround(pairs_left / around))), mesh);
  return mesh;
}

}  // namespace depth_object_tracker
