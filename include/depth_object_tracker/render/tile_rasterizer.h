// SPDX-License-Identifier: BSD-3-Clause
// Draws faces into a depth tile. Corners are snapped to 1/256 pixel, so that the fill rule is exact in integers: every
// pixel centre on an edge belongs to one of its two faces, and all instruction sets cover the same pixels.
#pragma once

#include "depth_object_tracker/geometry/pinhole_camera.h"
#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/render/depth_tile.h"
#include "depth_object_tracker/render/face_set.h"

#include <cstdint>
#include <vector>

namespace depth_object_tracker {

/// Pose and camera as the rasteriser wants them; pixel coordinates count from the tile's first cell.
struct RasterTransform {
  static constexpr int kSubpixelBits = 8;

  /// @param T_camera_object all faces must lie beyond the near plane.
  RasterTransform(const Pose& T_camera_object, const PinholeCamera& camera, const DepthTile& tile);

  float u[4], v[4], z[4];      ///< (u[0..2] . p + u[3]) / (z[0..2] . p + z[3]) = column in sub-pixels
  float by_col[3], by_row[3];  ///< a face's depth at (row, col) is (offset - normal . eye) / (at_origin . normal + ...
  float at_origin[3];          ///< ... row * by_row . normal + col * by_col . normal)
  float eye[3];                ///< camera centre [m], object frame
};

/// Faces that passed the first stage and wait to be filled.
struct PendingFaces {
  AlignedVector<std::int32_t> corner[6];  ///< xa, ya, xb, yb, xc, yc [1/256 px]
  AlignedVector<float> plane[6];          ///< numerator, by_col, by_row, at_origin, least and largest depth
  AlignedVector<std::int32_t> id;
  std::size_t count = 0;
};

/// Memory that the rasteriser uses between its stages.
struct RasterScratch {
  /// Makes room, once for all, for sets of up to this many faces.
  void reserve(std::size_t faces);

  static constexpr std::size_t kSizes = 4;
  static constexpr std::size_t kHitCapacity = 4096;  ///< pixels found that wait to be written
  static constexpr std::size_t kSlack = 32;          ///< whole vectors are written beyond the end
  PendingFaces pending[kSizes];       ///< by the number of pixels in their bounding boxes, small ones first
  AlignedVector<std::int32_t> large;  ///< indices of faces larger than that
  std::size_t num_large = 0;
  AlignedVector<std::int32_t> hit_cell, hit_id;
  AlignedVector<float> hit_depth;
};

/// Nearest depth of the faces at every pixel centre of the tile; with `with_faces` also whose it is.
/// Dispatches to the instruction set in use; `rasterizeScalar` is the reference, with the same result to the bit.
void rasterize(const FaceSet& faces, const RasterTransform& transform, bool with_faces, DepthTile& tile,
               RasterScratch& scratch);
void rasterizeScalar(const FaceSet& faces, const RasterTransform& transform, DepthTile& tile);
void rasterizeSimd(const FaceSet& faces, const RasterTransform& transform, bool with_faces, DepthTile& tile,
                   RasterScratch& scratch);

}  // namespace depth_object_tracker
