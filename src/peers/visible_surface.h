// SPDX-License-Identifier: BSD-3-Clause
// Points of the object's surface that the camera would see.
#pragma once

#include "depth_object_tracker/render/depth_renderer.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace depth_object_tracker {

struct SurfacePoint {
  Eigen::Vector3f p_camera;       ///< [m]
  Eigen::Vector3f normal_camera;  ///< unit, towards the camera
};

class VisibleSurface {
 public:
  explicit VisibleSurface(const TriangleMesh& mesh);

  /// At most `count` points, evenly spread over the pixels that the object covers at the pose; empty when it covers
  /// none.
  std::vector<SurfacePoint> points(const Pose& T_camera_object, const PinholeCamera& camera, std::size_t count);

 private:
  std::vector<Eigen::Vector3f> normals_object_;  // of the triangles, zero where there is no area
  DepthRenderer renderer_;
};

}  // namespace depth_object_tracker
