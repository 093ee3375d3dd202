// SPDX-License-Identifier: BSD-3-Clause
// Every beam against every triangle in double precision: slow, and shares no line of thought with the renderer.
#pragma once

#include "depth_object_tracker/geometry/pinhole_camera.h"
#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/geometry/triangle_mesh.h"

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace depth_object_tracker {

struct BeamHit {
  double depth = std::numeric_limits<double>::infinity();         ///< nearest surface, infinity where there is none
  double second_depth = std::numeric_limits<double>::infinity();  ///< next one behind it
  std::uint32_t triangle = 0;
  /// Rounding may decide otherwise: the beam passes an edge that matters, or the near plane, closer than the tolerance.
  bool is_uncertain = false;
};

/// Signed-volume test. With corners p_k in the camera, beam d and n_k = p_i x p_j (the plane through the camera's
/// centre and edge k), the beam meets the triangle when all n_k . d have one sign, at depth D / sum(n_k . d) with D =
/// p_0 . (p_1 x p_2). It holds for corners behind the camera too. n_k . d is linear in the pixel, so its distance from
/// the edge is in reach.
class BruteForceRenderer {
 public:
  BruteForceRenderer(const TriangleMesh& mesh, const Pose& T_camera_object, const PinholeCamera& camera, double near_m)
      : camera_(camera), near_m_(near_m) {
    for (const auto& [a, b, c] : mesh.triangles) {
      const Eigen::Vector3d p0 = T_camera_object * mesh.vertices[a].cast<double>();
      const Eigen::Vector3d p1 = T_camera_object * mesh.vertices[b].cast<double>();
      const Eigen::Vector3d p2 = T_camera_object * mesh.vertices[c].cast<double>();
      Triangle triangle;
      triangle.volume = p0.dot(p1.cross(p2));
      triangle.planes = {p1.cross(p2), p2.cross(p0), p0.cross(p1)};
      for (std::size_t k = 0; k < 3; ++k) {
        const double per_pixel = std::hypot(triangle.planes[k].x() / camera.fx, triangle.planes[k].y() / camera.fy);
        triangle.pixels_per_volume[k] = per_pixel > 0.0 ? 1.0 / per_pixel : 0.0;
      }
      triangles_.push_back(triangle);
    }
  }

  /// @param tolerance_px beams closer to an edge than this are uncertain.
  BeamHit cast(int row, int col, double tolerance_px) const {
    const Eigen::Vector3d beam = camera_.ray(col, row);
    BeamHit hit;
    double nearest_uncertain = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      const Triangle& triangle = triangles_[i];
      std::array<double, 3> side{};
      double sum = 0.0;
      for (std::size_t k = 0; k < 3; ++k) sum += side[k] = triangle.planes[k].dot(beam);
      if (sum == 0.0) continue;
      const double sign = sum > 0.0 ? 1.0 : -1.0;
      double inside_px = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < 3; ++k)
        inside_px = std::min(inside_px, sign * side[k] * triangle.pixels_per_volume[k]);
      if (inside_px < -tolerance_px) continue;
      const double depth = triangle.volume / sum;
      if (depth < near_m_ - kNearTolerance) continue;
      if (inside_px <= tolerance_px || depth < near_m_ + kNearTolerance) {
        nearest_uncertain = std::min(nearest_uncertain, depth);
      } else if (depth < hit.depth) {
        hit.second_depth = hit.depth;
        hit.depth = depth;
        hit.triangle = static_cast<std::uint32_t>(i);
      } else {
        hit.second_depth = std::min(hit.second_depth, depth);
      }
    }
    hit.is_uncertain = nearest_uncertain < hit.depth;
    return hit;
  }

 private:
  static constexpr double kNearTolerance = 1e-6;
  struct Triangle {
    std::array<Eigen::Vector3d, 3> planes;
    std::array<double, 3> pixels_per_volume;
    double volume;
  };
  PinholeCamera camera_;
  double near_m_;
  std::vector<Triangle> triangles_;
};

}  // namespace depth_object_tracker
