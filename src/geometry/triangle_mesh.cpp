// SPDX-License-Identifier: BSD-3-Clause
// Size, centre and clean-up of triangle meshes.
#include "depth_object_tracker/geometry/triangle_mesh.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace depth_object_tracker {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// Directions spread evenly over a half sphere (golden-angle spiral): neighbours are less than 0.1 rad apart.
constexpr int kNumExtremeDirections = 400;

bool hasValidCorners(const TriangleMesh& mesh, const Triangle& triangle) {
  for (const std::uint32_t index : triangle) {
    if (index >= mesh.vertices.size() || !mesh.vertices[index].allFinite()) return false;
  }
  return true;
}

Eigen::Vector3d spiralDirection(int index) {
  const double golden_angle = M_PI * (3.0 - std::sqrt(5.0));
  const double z = (index + 0.5) / kNumExtremeDirections;
  const double radius = std::sqrt(1.0 - z * z);
  return {radius * std::cos(golden_angle * index), radius * std::sin(golden_angle * index), z};
}

/// Each vertex that a valid triangle uses, once.
std::vector<Eigen::Vector3f> usedVertices(const TriangleMesh& mesh) {
  std::vector<bool> is_used(mesh.vertices.size(), false);
  for (const Triangle& triangle : mesh.triangles) {
    if (!hasValidCorners(mesh, triangle)) continue;
    for (const std::uint32_t index : triangle) is_used[index] = true;
  }
  std::vector<Eigen::Vector3f> used;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (is_used[i]) used.push_back(mesh.vertices[i]);
  }
  return used;
}

std::vector<Eigen::Vector3d> extremeVertices(const std::vector<Eigen::Vector3f>& vertices) {
  std::vector<std::size_t> extreme;
  for (int direction_index = 0; direction_index < kNumExtremeDirections; ++direction_index) {
    const Eigen::Vector3f direction = spiralDirection(direction_index).cast<float>();
    float lowest = std::numeric_limits<float>::infinity();
    float highest = -lowest;
    std::size_t lowest_index = 0, highest_index = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const float height = direction.dot(vertices[i]);
      if (height < lowest) lowest = height, lowest_index = i;
      if (height > highest) highest = height, highest_index = i;
    }
    extreme.push_back(lowest_index);
    extreme.push_back(highest_index);
  }
  std::sort(extreme.begin(), extreme.end());
  extreme.erase(std::unique(extreme.begin(), extreme.end()), extreme.end());
  std::vector<Eigen::Vector3d> points;
  points.reserve(extreme.size());
  for (const std::size_t index : extreme) points.push_back(vertices[index].cast<double>());
  return points;
}

/// A sliver whose height is lost in the rounding of its corners covers no beam and has no normal.
bool hasNoArea(const TriangleMesh& mesh, const Triangle& triangle, double mesh_size) {
  const Eigen::Vector3d a = mesh.vertices[triangle[0]].cast<double>();
  const Eigen::Vector3d ab = mesh.vertices[triangle[1]].cast<double>() - a;
  const Eigen::Vector3d ac = mesh.vertices[triangle[2]].cast<double>() - a;
  const double longest_squared = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
  return ab.cross(ac).norm() <= std::max(1e-7 * longest_squared, 1e-14 * mesh_size * mesh_size);
}

}  // namespace

BoundingBox boundingBox(const TriangleMesh& mesh) {
  BoundingBox box;
  bool is_empty = true;
  for (const Triangle& triangle : mesh.triangles) {
    if (!hasValidCorners(mesh, triangle)) continue;
    for (const std::uint32_t index : triangle) {
      const Eigen::Vector3d vertex = mesh.vertices[index].cast<double>();
      box.min = is_empty ? vertex : Eigen::Vector3d(box.min.cwiseMin(vertex));
      box.max = is_empty ? vertex : Eigen::Vector3d(box.max.cwiseMax(vertex));
      is_empty = false;
    }
  }
  return box;
}

double diameter(const TriangleMesh& mesh) {
  const std::vector<Eigen::Vector3f> used = usedVertices(mesh);
  if (used.empty()) return 0.0;
  const std::vector<Eigen::Vector3d> points = extremeVertices(used);
  double largest_squared = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      largest_squared = std::max(largest_squared, (points[i] - points[j]).squaredNorm());
    }
  }
  return std::sqrt(largest_squared);
}

Eigen::Vector3d surfaceCentroid(const TriangleMesh& mesh) {
  Eigen::Vector3d weighted_sum = Eigen::Vector3d::Zero();
  double total_area = 0.0;
  for (const Triangle& triangle : mesh.triangles) {
    if (!hasValidCorners(mesh, triangle)) continue;
    const Eigen::Vector3d a = mesh.vertices[triangle[0]].cast<double>();
    const Eigen::Vector3d b = mesh.vertices[triangle[1]].cast<double>();
    const Eigen::Vector3d c = mesh.vertices[triangle[2]].cast<double>();
    const double area = 0.5 * (b - a).cross(c - a).norm();
    weighted_sum += area * (a + b + c) / 3.0;
    total_area += area;
  }
  if (total_area > 0.0) return weighted_sum / total_area;
  const BoundingBox box = boundingBox(mesh);
  return 0.5 * (box.min + box.max);
}

std::size_t removeDegenerateTriangles(TriangleMesh& mesh) {
  const double mesh_size = boundingBox(mesh).size().norm();
  const auto is_degenerate = [&](const Triangle& triangle) {
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) return true;
    return !hasValidCorners(mesh, triangle) || hasNoArea(mesh, triangle, mesh_size);
  };
  const auto first_removed = std::remove_if(mesh.triangles.begin(), mesh.triangles.end(), is_degenerate);
  const auto num_removed = static_cast<std::size_t>(mesh.triangles.end() - first_removed);
  mesh.triangles.erase(first_removed, mesh.triangles.end());
  return num_removed;
}

}  // namespace depth_object_tracker
