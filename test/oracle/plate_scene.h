// SPDX-License-Identifier: BSD-3-Clause
// A square plate before a camera of a few pixels, and images written by hand.
#pragma once

#include "depth_object_tracker/geometry/depth_image.h"
#include "depth_object_tracker/geometry/pinhole_camera.h"
#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/geometry/triangle_mesh.h"

#include <vector>

namespace depth_object_tracker {

/// Two triangles in the plane z = 0 about the origin.
inline TriangleMesh makePlate(float half_width) {
  TriangleMesh mesh;
  mesh.vertices = {{-half_width, -half_width, 0},
                   {half_width, -half_width, 0},
                   {half_width, half_width, 0},
                   {-half_width, half_width, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

inline Pose poseAt(double x, double y, double z) {
  Pose pose = Pose::Identity();
  pose.translation() << x, y, z;
  return pose;
}

inline PinholeCamera makeCamera(int width, int height, double focal) {
  PinholeCamera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = focal;
  camera.cx = 0.5 * (width - 1);
  camera.cy = 0.5 * (height - 1);
  return camera;
}

/// View of a row-major float image in metres, which must outlive it.
inline DepthImageView viewOf(const std::vector<float>& depth_m, const PinholeCamera& camera) {
  DepthImageView view;
  view.data = reinterpret_cast<const std::uint8_t*>(depth_m.data());
  view.width = camera.width;
  view.height = camera.height;
  view.step = static_cast<std::size_t>(camera.width) * sizeof(float);
  view.pixel_type = DepthImageView::PixelType::kFloat32;
  view.unit_m = 1.0f;
  return view;
}

}  // namespace depth_object_tracker
