// SPDX-License-Identifier: BSD-3-Clause
// Boxes, ellipsoids and capsules as triangle meshes.
#include "depth_object_tracker/geometry/shape_meshes.h"

#include <cmath>

namespace depth_object_tracker {
namespace {

// Rings of `segments` vertices, closed by one vertex at either end: a surface of revolution about z, scaled per ring.
struct Ring {
  double z;
  double radius;
};

TriangleMesh revolve(const std::vector<Ring>& rings, double bottom_z, double top_z, int segments) {
  TriangleMesh mesh;
  for (const Ring& ring : rings) {
    for (int k = 0; k < segments; ++k) {
      const double angle = 2.0 * M_PI * k / segments;
      mesh.vertices.emplace_back(static_cast<float>(ring.radius * std::cos(angle)),
                                 static_cast<float>(ring.radius * std::sin(angle)), static_cast<float>(ring.z));
    }
  }
  const auto bottom = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.emplace_back(0.0f, 0.0f, static_cast<float>(bottom_z));
  mesh.vertices.emplace_back(0.0f, 0.0f, static_cast<float>(top_z));
  const auto n = static_cast<std::uint32_t>(segments);
  const std::uint32_t last = bottom - n;
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t next = (k + 1) % n;
    for (std::uint32_t base = 0; base + n < bottom; base += n) {
      mesh.triangles.push_back({base + k, base + next, base + n + next});
      mesh.triangles.push_back({base + k, base + n + next, base + n + k});
    }
    mesh.triangles.push_back({next, k, bottom});
    mesh.triangles.push_back({last + k, last + next, bottom + 1});
  }
  return mesh;
}

}  // namespace

TriangleMesh makeBox(const Eigen::Vector3d& size) {
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d sign((corner & 1) ? 0.5 : -0.5, (corner & 2) ? 0.5 : -0.5, (corner & 4) ? 0.5 : -0.5);
    mesh.vertices.push_back(size.cwiseProduct(sign).cast<float>());
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TriangleMesh makeEllipsoid(const Eigen::Vector3d& radii, int segments) {
  std::vector<Ring> rings;
  const int num_rings = segments / 2;
  for (int k = 1; k < num_rings; ++k) {
    const double angle = M_PI * k / num_rings;
    rings.push_back({-std::cos(angle), std::sin(angle)});
  }
  TriangleMesh mesh = revolve(rings, -1.0, 1.0, segments);
  const Eigen::Vector3f scale = radii.cast<float>();
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex = vertex.cwiseProduct(scale);
  return mesh;
}

TriangleMesh makeCapsule(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius_from_m,
                         double radius_to_m, int segments) {
  const double length = (to - from).norm();
  std::vector<Ring> rings;
  constexpr int kCapRings = 3;
  for (int k = 1; k <= kCapRings; ++k) {
    const double angle = 0.5 * M_PI * k / kCapRings;
    rings.push_back({-radius_from_m * std::cos(angle), radius_from_m * std::sin(angle)});
  }
  for (int k = kCapRings; k >= 1; --k) {
    const double angle = 0.5 * M_PI * k / kCapRings;
    rings.push_back({length + radius_to_m * std::cos(angle), radius_to_m * std::sin(angle)});
  }
  const TriangleMesh along_z = revolve(rings, -radius_from_m, length + radius_to_m, segments);
  Pose T_mesh_capsule = Pose::Identity();
  T_mesh_capsule.translation() = from;
  if (length > 0.0) T_mesh_capsule.linear() = rotationWithZ(to - from);
  TriangleMesh mesh;
  appendMesh(mesh, along_z, T_mesh_capsule);
  return mesh;
}

TriangleMesh makeCylinder(double radius_m, double length_m, int segments) {
  const double half = 0.5 * length_m;
  return revolve({{-half, radius_m}, {half, radius_m}}, -half, half, segments);
}

void appendMesh(TriangleMesh& mesh, const TriangleMesh& part, const Pose& T_mesh_part) {
  const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Eigen::Vector3f& vertex : part.vertices) {
    mesh.vertices.push_back((T_mesh_part * vertex.cast<double>()).cast<float>());
  }
  for (const auto& triangle : part.triangles) {
    mesh.triangles.push_back({triangle[0] + offset, triangle[1] + offset, triangle[2] + offset});
  }
}

Eigen::Matrix3d rotationWithZ(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d z = direction.normalized();
  const Eigen::Vector3d helper = std::abs(z.x()) < 0.8 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  const Eigen::Vector3d y = z.cross(helper).normalized();
  Eigen::Matrix3d rotation;
  rotation << y.cross(z), y, z;
  return rotation;
}

}  // namespace depth_object_tracker
