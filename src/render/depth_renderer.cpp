// SPDX-License-Identifier: BSD-3-Clause
// Two stages: single-precision bounding boxes throw away the many triangles that hold no pixel centre; the few that may
// are drawn in double precision, so that depth is exact and shared edges leave neither holes nor double hits.
#include "depth_object_tracker/render/depth_renderer.h"

#include "depth_object_tracker/geometry/mesh_orientation.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depth_object_tracker {
namespace {

constexpr float kEmpty = std::numeric_limits<float>::infinity();
// Bound on the error of single-precision pixel coordinates inside of the image; only makes the first stage keep more.
constexpr float kProjectionSlackPx = 4e-3f;

/// Directed line through two image points. The side on which a point lies is antisymmetric in the points to the last
/// bit, because they are taken in one canonical order: the two triangles at an edge then agree about every pixel
/// centre.
class Edge {
 public:
  Edge() = default;
  Edge(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const bool ordered = a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
    const Eigen::Vector2d& from = ordered ? a : b;
    const Eigen::Vector2d& to = ordered ? b : a;
    x_ = from.x();
    y_ = from.y();
    dx_ = ordered ? to.x() - from.x() : -(to.x() - from.x());
    dy_ = ordered ? to.y() - from.y() : -(to.y() - from.y());
    // Of the two triangles at an edge exactly one owns the pixel centres that lie on it.
    owns_line_ = b.y() > a.y() || (b.y() == a.y() && b.x() < a.x());
  }
  /// Twice the signed area of the triangle with a point.
  double side(double x, double y) const { return dx_ * (y - y_) - dy_ * (x - x_); }
  bool contains(double x, double y) const {
    const double value = side(x, y);
    return value > 0.0 || (value == 0.0 && owns_line_);
  }

 private:
  double x_ = 0.0, y_ = 0.0, dx_ = 0.0, dy_ = 0.0;
  bool owns_line_ = false;
};

/// Point where the edge from `inside` to `outside` meets the near plane; the same bits whichever triangle asks.
Eigen::Vector3d cutAtNearPlane(const Eigen::Vector3d& inside, const Eigen::Vector3d& outside) {
  const double share = (kNearPlaneM - outside.z()) / (inside.z() - outside.z());
  Eigen::Vector3d point = outside + share * (inside - outside);
  point.z() = kNearPlaneM;
  return point;
}

int firstPixel(double coordinate) {
  return static_cast<int>(std::ceil(coordinate));
}
int lastPixel(double coordinate) {
  return static_cast<int>(std::floor(coordinate));
}

}  // namespace

DepthRenderer::DepthRenderer(const TriangleMesh& mesh)
    : triangles_(mesh.triangles), faces_outward_(orientOutward(mesh, triangles_)) {
  const std::size_t count = mesh.vertices.size();
  for (auto* array : {&object_x_, &object_y_, &object_z_, &u_, &v_, &z_}) array->resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    object_x_[i] = mesh.vertices[i].x();
    object_y_[i] = mesh.vertices[i].y();
    object_z_[i] = mesh.vertices[i].z();
  }
}

const std::vector<CoveredPixel>& DepthRenderer::render(const Pose& T_camera_object, const PinholeCamera& camera) {
  const std::size_t num_pixels = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  if (depth_buffer_.size() != num_pixels) {
    depth_buffer_.assign(num_pixels, kEmpty);
    triangle_buffer_.assign(num_pixels, 0);
  }
  T_camera_object_ = T_camera_object;
  camera_ = camera;
  drawn_ = {camera.height, -1, camera.width, -1};
  projectVertices();
  drawTriangles();
  collectCovered();
  return covered_;
}

void DepthRenderer::projectVertices() {
  const Eigen::Matrix3f R = T_camera_object_.linear().cast<float>();
  const Eigen::Vector3f t = T_camera_object_.translation().cast<float>();
  const float r00 = R(0, 0), r01 = R(0, 1), r02 = R(0, 2), r10 = R(1, 0), r11 = R(1, 1), r12 = R(1, 2);
  const float r20 = R(2, 0), r21 = R(2, 1), r22 = R(2, 2), tx = t.x(), ty = t.y(), tz = t.z();
  const float fx = static_cast<float>(camera_.fx), fy = static_cast<float>(camera_.fy);
  const float cx = static_cast<float>(camera_.cx), cy = static_cast<float>(camera_.cy);
  const std::size_t count = object_x_.size();
  const float* __restrict x = object_x_.data();
  const float* __restrict y = object_y_.data();
  const float* __restrict z = object_z_.data();
  float* __restrict u = u_.data();
  float* __restrict v = v_.data();
  float* __restrict depth = z_.data();
  for (std::size_t i = 0; i < count; ++i) {
    const float camera_z = r20 * x[i] + r21 * y[i] + r22 * z[i] + tz;
    const float inverse = 1.0f / camera_z;
    u[i] = fx * (r00 * x[i] + r01 * y[i] + r02 * z[i] + tx) * inverse + cx;
    v[i] = fy * (r10 * x[i] + r11 * y[i] + r12 * z[i] + ty) * inverse + cy;
    depth[i] = camera_z;
  }
}

void DepthRenderer::drawTriangles() {
  // Single-precision depth near the plane may be wrong by a rounding; such triangles take the careful path.
  const float safe_z = static_cast<float>(kNearPlaneM) * 1.001f;
  const float nearest = z_.empty() ? 0.0f : *std::min_element(z_.begin(), z_.end());
  if (nearest > safe_z) {
    return faces_outward_ ? drawInFrontOfNearPlane<true>() : drawInFrontOfNearPlane<false>();
  }
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const auto& [a, b, c] = triangles_[i];
    const auto id = static_cast<std::uint32_t>(i);
    if (std::max({z_[a], z_[b], z_[c]}) > static_cast<float>(kNearPlaneM) * 0.999f)
      drawClipped(cornersInCamera(id), id);
  }
}

template <bool kCullBackFaces>
void DepthRenderer::drawInFrontOfNearPlane() {
  const float max_u = static_cast<float>(camera_.width - 1), max_v = static_cast<float>(camera_.height - 1);
  const auto num_triangles = static_cast<std::uint32_t>(triangles_.size());
  candidates_.resize(num_triangles);
  std::size_t num_candidates = 0;
  for (std::uint32_t i = 0; i < num_triangles; ++i) {
    const auto [a, b, c] = triangles_[i];
    const float ua = u_[a], ub = u_[b], uc = u_[c], va = v_[a], vb = v_[b], vc = v_[c];
    const float u0 = std::max(std::min(std::min(ua, ub), uc) - kProjectionSlackPx, -1.0f);
    const float u1 = std::min(std::max(std::max(ua, ub), uc) + kProjectionSlackPx, max_u);
    const float v0 = std::max(std::min(std::min(va, vb), vc) - kProjectionSlackPx, -1.0f);
    const float v1 = std::min(std::max(std::max(va, vb), vc) + kProjectionSlackPx, max_v);
    // Clamped to the image, coordinates are positive and truncation is floor: equal floors mean no pixel centre
    // between.
    const bool spans_centre = (static_cast<int>(u0 + 1.0f) < static_cast<int>(u1 + 1.0f)) &
                              (static_cast<int>(v0 + 1.0f) < static_cast<int>(v1 + 1.0f));
    // Counter-clockwise from outside is negative in an image whose y axis points down. What is too close to call is
    // left to double precision, here and below.
    const float area = (ub - ua) * (vc - va) - (vb - va) * (uc - ua);
    const bool may_face_camera = !kCullBackFaces | (area <= kProjectionSlackPx * (u1 - u0 + v1 - v0));
    // No branch: which triangles pass is close to random.
    candidates_[num_candidates] = i;
    num_candidates += static_cast<std::size_t>(spans_centre & may_face_camera);
  }
  for (std::size_t k = 0; k < num_candidates; ++k) {
    const std::uint32_t triangle = candidates_[k];
    if (missesItsOnlyPixel(triangle)) continue;
    const Corners corners = cornersInCamera(triangle);
    drawVisible(corners, (corners[1] - corners[0]).cross(corners[2] - corners[0]), triangle);
  }
}

bool DepthRenderer::missesItsOnlyPixel(std::uint32_t triangle) const {
  const auto [a, b, c] = triangles_[triangle];
  const float ua = u_[a], ub = u_[b], uc = u_[c], va = v_[a], vb = v_[b], vc = v_[c];
  const float u0 = std::min(std::min(ua, ub), uc) - kProjectionSlackPx,
              u1 = std::max(std::max(ua, ub), uc) + kProjectionSlackPx;
  const float v0 = std::min(std::min(va, vb), vc) - kProjectionSlackPx,
              v1 = std::max(std::max(va, vb), vc) + kProjectionSlackPx;
  const float x = std::ceil(u0), y = std::ceil(v0);
  if (x + 1.0f <= u1 || y + 1.0f <= v1) return false;
  const float abx = ub - ua, aby = vb - va, acx = uc - ua, acy = vc - va;
  const float sign = abx * acy - aby * acx < 0.0f ? -1.0f : 1.0f;
  const float slack = kProjectionSlackPx * (u1 - u0 + v1 - v0);
  const float side_ab = sign * (abx * (y - va) - aby * (x - ua));
  const float side_bc = sign * ((uc - ub) * (y - vb) - (vc - vb) * (x - ub));
  const float side_ca = sign * (acy * (x - uc) - acx * (y - vc));
  return (side_ab < -slack) | (side_bc < -slack) | (side_ca < -slack);
}

DepthRenderer::Corners DepthRenderer::cornersInCamera(std::uint32_t triangle) const {
  Corners corners;
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t vertex = triangles_[triangle][static_cast<std::size_t>(k)];
    corners[static_cast<std::size_t>(k)] =
        T_camera_object_ * Eigen::Vector3d(object_x_[vertex], object_y_[vertex], object_z_[vertex]);
  }
  return corners;
}

void DepthRenderer::drawClipped(const Corners& corners, std::uint32_t triangle) {
  const Eigen::Vector3d plane = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  std::array<Eigen::Vector3d, 4> polygon;
  std::size_t count = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d& from = corners[k];
    const Eigen::Vector3d& to = corners[(k + 1) % 3];
    const bool from_inside = from.z() > kNearPlaneM, to_inside = to.z() > kNearPlaneM;
    if (from_inside) polygon[count++] = from;
    if (from_inside != to_inside) polygon[count++] = from_inside ? cutAtNearPlane(from, to) : cutAtNearPlane(to, from);
  }
  if (count >= 3) drawVisible({polygon[0], polygon[1], polygon[2]}, plane, triangle);
  if (count == 4) drawVisible({polygon[0], polygon[2], polygon[3]}, plane, triangle);
}

void DepthRenderer::drawVisible(const Corners& corners, const Eigen::Vector3d& plane, std::uint32_t triangle) {
  std::array<Eigen::Vector2d, 3> p;
  for (std::size_t k = 0; k < 3; ++k) p[k] = camera_.project(corners[k]);
  const double plane_offset = plane.dot(corners[0]);
  std::array<Edge, 3> edges = {Edge(p[0], p[1]), Edge(p[1], p[2]), Edge(p[2], p[0])};
  const double area = edges[0].side(p[2].x(), p[2].y());
  if (area == 0.0 || plane_offset == 0.0) return;  // seen edge-on: no pixel centre is inside
  if (area < 0.0) edges = {Edge(p[1], p[0]), Edge(p[2], p[1]), Edge(p[0], p[2])};
  const auto [min_u, max_u] = std::minmax({p[0].x(), p[1].x(), p[2].x()});
  const auto [min_v, max_v] = std::minmax({p[0].y(), p[1].y(), p[2].y()});
  if (max_u < 0.0 || max_v < 0.0 || min_u > camera_.width - 1 || min_v > camera_.height - 1) return;
  const int first_col = firstPixel(std::max(min_u, 0.0)),
            last_col = lastPixel(std::min<double>(max_u, camera_.width - 1));
  const int first_row = firstPixel(std::max(min_v, 0.0)),
            last_row = lastPixel(std::min<double>(max_v, camera_.height - 1));
  if (first_col > last_col || first_row > last_row) return;

  // The beam meets the plane n.p = n.p0 at depth n.p0 / n.ray; n.ray is linear in the pixel.
  const double per_col = plane.x() / camera_.fx, per_row = plane.y() / camera_.fy;
  const double constant = plane.z() - per_col * camera_.cx - per_row * camera_.cy;
  for (int row = first_row; row <= last_row; ++row) {
    for (int col = first_col; col <= last_col; ++col) {
      if (!edges[0].contains(col, row) || !edges[1].contains(col, row) || !edges[2].contains(col, row)) continue;
      const float depth = static_cast<float>(plane_offset / (constant + per_col * col + per_row * row));
      const std::size_t index = static_cast<std::size_t>(row) * static_cast<std::size_t>(camera_.width) + col;
      if (!(depth < depth_buffer_[index])) continue;
      depth_buffer_[index] = depth;
      triangle_buffer_[index] = triangle;
    }
  }
  drawn_.min_row = std::min(drawn_.min_row, first_row);
  drawn_.max_row = std::max(drawn_.max_row, last_row);
  drawn_.min_col = std::min(drawn_.min_col, first_col);
  drawn_.max_col = std::max(drawn_.max_col, last_col);
}

void DepthRenderer::collectCovered() {
  covered_.clear();
  for (int row = drawn_.min_row; row <= drawn_.max_row; ++row) {
    const std::size_t row_start = static_cast<std::size_t>(row) * static_cast<std::size_t>(camera_.width);
    for (int col = drawn_.min_col; col <= drawn_.max_col; ++col) {
      float& depth = depth_buffer_[row_start + col];
      if (depth == kEmpty) continue;
      covered_.push_back({row, col, triangle_buffer_[row_start + col], depth});
      depth = kEmpty;
    }
  }
}

}  // namespace depth_object_tracker
