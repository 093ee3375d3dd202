// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/render/tile_renderer.h"

#include "depth_object_tracker/render/depth_renderer.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

constexpr int kMargin = 3;  // two rings of soft outline, and one cell that is surely empty
// Eyes this share of their distance apart share a selection of faces.
constexpr float kSharedFacingAngle = 0.09f;
constexpr int kMissesToMove = 6;

bool reachesNearPlane(const RenderObject& object, const Pose& T_camera_object) {
  const Eigen::RowVector3d z_axis = T_camera_object.linear().row(2);
  const Eigen::Vector3d nearest = (z_axis.transpose().array() > 0.0).select(object.box.min, object.box.max);
  return !(z_axis * nearest + T_camera_object.translation().z() > 1.01 * kNearPlaneM);
}

}  // namespace

RenderObject::RenderObject(const TriangleMesh& triangle_mesh, double mesh_error_m)
    : mesh(triangle_mesh), faces(makeFaceSet(triangle_mesh)), box(boundingBox(triangle_mesh)), error_m(mesh_error_m) {}

CellBox TileRenderer::coveredBox(const RenderObject& object, const Pose& T_camera_object, const PinholeCamera& camera) {
  const CellBox image{0, camera.height, 0, camera.width};
  if (reachesNearPlane(object, T_camera_object)) return image;
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9), high = -low;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d p_object((corner & 1) != 0 ? object.box.max.x() : object.box.min.x(),
                                   (corner & 2) != 0 ? object.box.max.y() : object.box.min.y(),
                                   (corner & 4) != 0 ? object.box.max.z() : object.box.min.z());
    const Eigen::Vector2d pixel = camera.project(T_camera_object * p_object);
    low = low.cwiseMin(pixel);
    high = high.cwiseMax(pixel);
  }
  const double limit = 1e6;
  const auto cell = [&](double coordinate) { return static_cast<int>(std::clamp(coordinate, -limit, limit)); };
  return intersect({cell(std::floor(low.y())) - kMargin, cell(std::ceil(high.y())) + kMargin + 1,
                    cell(std::floor(low.x())) - kMargin, cell(std::ceil(high.x())) + kMargin + 1},
                   image);
}

const DepthTile& TileRenderer::render(const RenderObject& object, const Pose& T_camera_object,
                                      const PinholeCamera& camera, const OutlineCoverage& outline,
                                      bool for_derivatives) {
  tile_.clear(coveredBox(object, T_camera_object, camera), {0, camera.height, 0, camera.width});
  if (tile_.touched.empty()) return tile_;
  if (reachesNearPlane(object, T_camera_object)) {
    drawAcrossNearPlane(object, T_camera_object, camera);
  } else {
    drawBeyondNearPlane(object, RasterTransform(T_camera_object, camera, tile_), for_derivatives);
  }
  softenOutline(outline, for_derivatives, tile_);
  return tile_;
}

void TileRenderer::drawBeyondNearPlane(const RenderObject& object, const RasterTransform& transform, bool with_faces) {
  rasterize(facesFor(object, Eigen::Vector3f(transform.eye[0], transform.eye[1], transform.eye[2])), transform,
            with_faces, tile_, scratch_);
}

const FaceSet& TileRenderer::facesFor(const RenderObject& object, const Eigen::Vector3f& eye_object) {
  if (facing_object_ == &object && (eye_object - facing_eye_).norm() <= facing_radius_) {
    misses_ = 0;
    return facing_;
  }
  // One pose among many may lie far from the others: for it all faces are drawn.
  if (facing_object_ == &object && ++misses_ < kMissesToMove) return object.faces;
  scratch_.reserve(object.faces.padded);
  facing_object_ = &object;
  facing_eye_ = eye_object;
  facing_radius_ = kSharedFacingAngle * eye_object.norm();
  misses_ = 0;
  selectFacing(object.faces, eye_object, facing_radius_, facing_);
  return facing_;
}

void TileRenderer::drawAcrossNearPlane(const RenderObject& object, const Pose& T_camera_object,
                                       const PinholeCamera& camera) {
  // A few centimetres before the lens: rare, no need to be quick or not to allocate.
  DepthRenderer renderer(object.mesh);
  for (const CoveredPixel& pixel : renderer.render(T_camera_object, camera)) {
    const int cell = (pixel.row - tile_.row_begin) * tile_.stride + pixel.col - tile_.col_begin;
    tile_.depth()[cell] = pixel.depth;
    tile_.face()[cell] = static_cast<std::int32_t>(pixel.triangle);
  }
}

}  // namespace depth_object_tracker
