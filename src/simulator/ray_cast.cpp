// SPDX-License-Identifier: BSD-3-Clause
// Ray against triangles, by Cramer's rule.
#include "depth_object_tracker/simulator/ray_cast.h"

#include <Eigen/Geometry>

#include <cmath>

namespace depth_object_tracker {

std::optional<double> castRay(const TriangleMesh& mesh, const Eigen::Vector3d& origin,
                              const Eigen::Vector3d& direction) {
  const Eigen::Vector3f from = origin.cast<float>(), along = direction.cast<float>();
  float nearest = std::numeric_limits<float>::infinity();
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector3f& corner = mesh.vertices[triangle[0]];
    const Eigen::Vector3f edge1 = mesh.vertices[triangle[1]] - corner;
    const Eigen::Vector3f edge2 = mesh.vertices[triangle[2]] - corner;
    const Eigen::Vector3f p = along.cross(edge2);
    const float determinant = edge1.dot(p);
    if (std::abs(determinant) < 1e-20f) continue;
    const Eigen::Vector3f to_origin = from - corner;
    const float u = to_origin.dot(p) / determinant;
    if (u < 0.0f || u > 1.0f) continue;
    const Eigen::Vector3f q = to_origin.cross(edge1);
    const float v = along.dot(q) / determinant;
    if (v < 0.0f || u + v > 1.0f) continue;
    const float distance = edge2.dot(q) / determinant;
    if (distance > 0.0f && distance < nearest) nearest = distance;
  }
  if (!std::isfinite(nearest)) return std::nullopt;
  return nearest;
}

}  // namespace depth_object_tracker
