// SPDX-License-Identifier: BSD-3-Clause
// Points of the object's surface that the camera would see.
#include "visible_surface.h"

#include <algorithm>

namespace depth_object_tracker {
namespace {

std::vector<Eigen::Vector3f> triangleNormals(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3f> normals;
  normals.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d ab = (mesh.vertices[b] - mesh.vertices[a]).cast<double>();
    const Eigen::Vector3d ac = (mesh.vertices[c] - mesh.vertices[a]).cast<double>();
    normals.push_back(ab.cross(ac).stableNormalized().cast<float>());
  }
  return normals;
}

}  // namespace

VisibleSurface::VisibleSurface(const TriangleMesh& mesh) : normals_object_(triangleNormals(mesh)), renderer_(mesh) {}

std::vector<SurfacePoint> VisibleSurface::points(const Pose& T_camera_object, const PinholeCamera& camera,
                                                 std::size_t count) {
  const std::vector<CoveredPixel>& covered = renderer_.render(T_camera_object, camera);
  const std::size_t chosen = std::min(count, covered.size());
  const Eigen::Matrix3f R = T_camera_object.linear().cast<float>();
  std::vector<SurfacePoint> points;
  points.reserve(chosen);
  for (std::size_t i = 0; i < chosen; ++i) {
    const CoveredPixel& pixel = covered[i * covered.size() / chosen];
    const Eigen::Vector3f p = (static_cast<double>(pixel.depth) * camera.ray(pixel.col, pixel.row)).cast<float>();
    const Eigen::Vector3f normal = R * normals_object_[pixel.triangle];
    points.push_back({p, normal.dot(p) > 0.0f ? Eigen::Vector3f(-normal) : normal});
  }
  return points;
}

}  // namespace depth_object_tracker
