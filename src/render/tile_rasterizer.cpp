// SPDX-License-Identifier: BSD-3-Clause
// The reference: one face, one row, one pixel at a time.
#include "depth_object_tracker/render/tile_rasterizer.h"

#include "depth_object_tracker/geometry/simd_target.h"
#include "render/raster_face.h"

namespace depth_object_tracker {

RasterTransform::RasterTransform(const Pose& T_camera_object, const PinholeCamera& camera, const DepthTile& tile) {
  const Eigen::Matrix3d R = T_camera_object.linear();
  const Eigen::Vector3d t = T_camera_object.translation();
  const double col = camera.cx - tile.col_begin, row = camera.cy - tile.row_begin;
  const Eigen::RowVector3d u_row = kSubpixels * (camera.fx * R.row(0) + col * R.row(2));
  const Eigen::RowVector3d v_row = kSubpixels * (camera.fy * R.row(1) + row * R.row(2));
  const Eigen::RowVector3d origin_row = R.row(2) - col / camera.fx * R.row(0) - row / camera.fy * R.row(1);
  const Eigen::Vector3d eye_object = -(R.transpose() * t);
  for (int k = 0; k < 3; ++k) {
    u[k] = static_cast<float>(u_row[k]);
    v[k] = static_cast<float>(v_row[k]);
    z[k] = static_cast<float>(R(2, k));
    by_col[k] = static_cast<float>(R(0, k) / camera.fx);
    by_row[k] = static_cast<float>(R(1, k) / camera.fy);
    at_origin[k] = static_cast<float>(origin_row[k]);
    eye[k] = static_cast<float>(eye_object[k]);
  }
  u[3] = static_cast<float>(kSubpixels * (camera.fx * t.x() + col * t.z()));
  v[3] = static_cast<float>(kSubpixels * (camera.fy * t.y() + row * t.z()));
  z[3] = static_cast<float>(t.z());
}

void RasterScratch::reserve(std::size_t faces) {
  const std::size_t needed = faces + kSlack;
  if (large.size() >= needed) return;
  for (PendingFaces& list : pending) {
    for (auto& array : list.corner) array.resize(needed);
    for (auto& array : list.plane) array.resize(needed);
    list.id.resize(needed);
  }
  large.resize(needed);
  hit_cell.resize(kHitCapacity + kSlack);
  hit_id.resize(kHitCapacity + kSlack);
  hit_depth.resize(kHitCapacity + kSlack);
}

void rasterizeScalar(const FaceSet& faces, const RasterTransform& transform, DepthTile& tile) {
  for (std::size_t i = 0; i < faces.count; ++i) {
    const RasterFace face = makeRasterFace(faces, i, transform, tile);
    for (int row = face.first_row; row <= face.last_row; ++row) {
      int first, last;
      face.span(row, first, last);
      float* depth = tile.depth() + tile.rowOffset(row);
      std::int32_t* id = tile.face() + tile.rowOffset(row);
      for (int col = first; col <= last; ++col) {
        const float value = face.depth(row, col);
        if (!(value < depth[col])) continue;
        depth[col] = value;
        id[col] = faces.id[i];
      }
    }
  }
}

void rasterize(const FaceSet& faces, const RasterTransform& transform, bool with_faces, DepthTile& tile,
               RasterScratch& scratch) {
#ifdef DEPTH_OBJECT_TRACKER_HAVE_HIGHWAY
  if (!simdIsScalar()) return rasterizeSimd(faces, transform, with_faces, tile, scratch);
#else
  (void)with_faces, (void)scratch;
#endif
  rasterizeScalar(faces, transform, tile);
}

}  // namespace depth_object_tracker
