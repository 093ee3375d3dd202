// SPDX-License-Identifier: BSD-3-Clause
// Predicted depth of a mesh at a pose: the nearest surface along every beam (z-buffer), exact at pixel centres.
#pragma once

#include "depth_object_tracker/geometry/pinhole_camera.h"
#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/geometry/triangle_mesh.h"

#include <cstdint>
#include <vector>

namespace depth_object_tracker {

constexpr double kNearPlaneM = 0.05;  ///< surfaces nearer to the camera than this are cut away

/// One pixel of the image that the object covers.
struct CoveredPixel {
  std::int32_t index;     ///< row * camera.width + col
  std::uint32_t triangle; ///< index of the nearest triangle
  float depth;            ///< [m] along the optical axis
};

/// Renders one mesh. Holds scratch memory: use one renderer per thread; after the first call nothing is allocated unless
/// an object covers more pixels than ever before. Renders only the region that the object can cover.
class DepthRenderer {
 public:
  /// The mesh is copied into a layout of its own; triangles are two-sided.
  explicit DepthRenderer(const TriangleMesh& mesh);

  /// Pixels covered by the mesh at a pose, row by row, left to right. The reference stays valid until the next call.
  /// @param T_camera_object finite; parts before the near plane or outside of the image are cut.
  const std::vector<CoveredPixel>& render(const Pose& T_camera_object, const PinholeCamera& camera);

 private:
  struct ImageTriangle;
  void projectVertices(const Pose& T_camera_object, const PinholeCamera& camera);
  void drawTriangles(const PinholeCamera& camera);
  void drawTriangle(const Eigen::Vector3d (&corners)[3], std::uint32_t triangle, const PinholeCamera& camera);
  void drawClipped(const Eigen::Vector3d (&corners)[3], std::uint32_t triangle, const PinholeCamera& camera);
  void collectCovered(const PinholeCamera& camera);
  Eigen::Vector3d cornerInCamera(std::uint32_t vertex) const;

  // Vertices in the object frame and, after projectVertices, in the camera, structure of arrays.
  std::vector<float> object_x_, object_y_, object_z_;
  std::vector<float> u_, v_, z_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  Pose T_camera_object_ = Pose::Identity();

  std::vector<float> depth_buffer_;              // image size; infinity where empty between calls
  std::vector<std::uint32_t> triangle_buffer_;   // image size
  int min_row_ = 0, max_row_ = -1, min_col_ = 0, max_col_ = -1;  // rectangle drawn in
  std::vector<CoveredPixel> covered_;
};

}  // namespace depth_object_tracker
