// SPDX-License-Identifier: BSD-3-Clause
// Points spread evenly over the surface of a mesh.
#include "mesh_samples.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

std::vector<double> cumulativeAreas(const TriangleMesh& mesh) {
  std::vector<double> areas;
  double total = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d ab = (mesh.vertices[b] - mesh.vertices[a]).cast<double>();
    const Eigen::Vector3d ac = (mesh.vertices[c] - mesh.vertices[a]).cast<double>();
    total += 0.5 * ab.cross(ac).norm();
    areas.push_back(total);
  }
  return areas;
}

}  // namespace

std::vector<Eigen::Vector3f> sampleSurface(const TriangleMesh& mesh, std::size_t count) {
  // Additive recurrence with the powers of the plastic number: low discrepancy in the plane.
  constexpr double kFirst = 0.7548776662466927;
  constexpr double kSecond = 0.5698402909980532;
  const std::vector<double> areas = cumulativeAreas(mesh);
  std::vector<Eigen::Vector3f> points;
  if (areas.empty() || !(areas.back() > 0.0)) return points;
  points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double area = areas.back() * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    const auto triangle = std::upper_bound(areas.begin(), areas.end() - 1, area) - areas.begin();
    double u = std::fmod(kFirst * static_cast<double>(i + 1), 1.0);
    double v = std::fmod(kSecond * static_cast<double>(i + 1), 1.0);
    if (u + v > 1.0) {
      u = 1.0 - u;
      v = 1.0 - v;
    }
    const auto& [a, b, c] = mesh.triangles[static_cast<std::size_t>(triangle)];
    points.push_back(mesh.vertices[a] + static_cast<float>(u) * (mesh.vertices[b] - mesh.vertices[a]) +
                     static_cast<float>(v) * (mesh.vertices[c] - mesh.vertices[a]));
  }
  return points;
}

}  // namespace depth_object_tracker
