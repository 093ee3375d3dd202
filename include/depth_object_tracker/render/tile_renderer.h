// SPDX-License-Identifier: BSD-3-Clause
// Renders one object at many poses: the part of the image that it covers, with its soft outline.
#pragma once

#include "depth_object_tracker/render/tile_outline.h"
#include "depth_object_tracker/render/tile_rasterizer.h"

#include <memory>

namespace depth_object_tracker {

/// A mesh prepared for rendering; shared by all renderers of the object.
struct RenderObject {
  /// @param error_m how far the mesh is from the object's surface (rms) [m]
  explicit RenderObject(const TriangleMesh& triangle_mesh, double error_m = 0.0);

  TriangleMesh mesh;
  FaceSet faces;
  BoundingBox box;  ///< [m], object frame
  double error_m;
};

/// Holds scratch memory: use one per thread. After warm-up nothing is allocated unless the object covers a larger box
/// than ever before.
class TileRenderer {
 public:
  /// Cells that the object can cover at a pose, its soft outline included; the whole image when it reaches the near
  /// plane.
  static CellBox coveredBox(const RenderObject& object, const Pose& T_camera_object, const PinholeCamera& camera);

  /// Depth, soft depth and coverage. @param for_derivatives also faces and distance to the outline.
  /// @param T_camera_object finite. The reference stays valid until the next call; so must `object`.
  const DepthTile& render(const RenderObject& object, const Pose& T_camera_object, const PinholeCamera& camera,
                          const OutlineCoverage& outline, bool for_derivatives);

 private:
  const FaceSet& facesFor(const RenderObject& object, const Eigen::Vector3f& eye_object);
  void drawBeyondNearPlane(const RenderObject& object, const RasterTransform& transform, bool with_faces);
  void drawAcrossNearPlane(const RenderObject& object, const Pose& T_camera_object, const PinholeCamera& camera);

  DepthTile tile_;
  RasterScratch scratch_;
  FaceSet facing_;  // of `facing_object_` that can be seen from around `facing_eye_`
  const RenderObject* facing_object_ = nullptr;
  Eigen::Vector3f facing_eye_ = Eigen::Vector3f::Zero();
  float facing_radius_ = 0.0f;
  int misses_ = 0;  // poses in a row that looked from elsewhere
};

}  // namespace depth_object_tracker
