// SPDX-License-Identifier: BSD-3-Clause
// Predicted depth of a mesh at a pose: the nearest surface along every beam (z-buffer), exact at pixel centres.
#pragma once

#include "depth_object_tracker/geometry/pinhole_camera.h"
#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/geometry/triangle_mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace depth_object_tracker {

constexpr double kNearPlaneM = 0.05;  ///< surfaces nearer to the camera than this are cut away

/// One pixel of the image that the object covers.
struct CoveredPixel {
  std::int32_t row;
  std::int32_t col;
  std::uint32_t triangle;  ///< index of the nearest triangle
  float depth;             ///< [m] along the optical axis
};

/// Renders one mesh. Holds scratch memory: use one renderer per thread. After warm-up nothing is allocated unless the
/// image grows or the object covers more pixels than ever before. Touches only the region that the object covers.
class DepthRenderer {
 public:
  /// The mesh is copied into a layout of its own; triangles are two-sided, indices must be valid.
  explicit DepthRenderer(const TriangleMesh& mesh);

  /// Pixels covered by the mesh at a pose, row by row, left to right. The reference stays valid until the next call.
  /// @param T_camera_object finite; parts before the near plane or outside of the image are cut.
  const std::vector<CoveredPixel>& render(const Pose& T_camera_object, const PinholeCamera& camera);

 private:
  using Corners = std::array<Eigen::Vector3d, 3>;  // camera frame
  struct Rectangle {
    int min_row, max_row, min_col, max_col;  // inclusive
  };

  void projectVertices();
  void drawTriangles();
  template <bool kCullBackFaces>
  void drawInFrontOfNearPlane();
  bool missesItsOnlyPixel(std::uint32_t triangle) const;
  Corners cornersInCamera(std::uint32_t triangle) const;
  void drawClipped(const Corners& corners, std::uint32_t triangle);
  void drawVisible(const Corners& corners, const Eigen::Vector3d& plane, std::uint32_t triangle);
  void collectCovered();

  std::vector<float> object_x_, object_y_, object_z_;  // vertices, object frame
  std::vector<float> u_, v_, z_;                       // the same, projected for this pose
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  bool faces_outward_ =
      false;  // closed surface, all triangles counter-clockwise from outside: back faces are never seen
  Pose T_camera_object_ = Pose::Identity();
  PinholeCamera camera_;

  std::vector<float> depth_buffer_;  // image size; infinity everywhere between calls
  std::vector<std::uint32_t> triangle_buffer_;
  std::vector<std::uint32_t> candidates_;  // triangles that may hold a pixel centre
  Rectangle drawn_{0, -1, 0, -1};
  std::vector<CoveredPixel> covered_;
};

}  // namespace depth_object_tracker
