// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/sparse_fit.h"

#include <algorithm>

namespace depth_object_tracker {
namespace {

constexpr std::size_t kMostPoints = 64;
constexpr double kTolerancePerDiameter = 0.06;
constexpr float kNoisePerM = 3.0f * 1.425e-3f;
constexpr int kSamplingFactor = 4;

}  // namespace

SparseFit::SparseFit(const std::vector<OrientedPoint>& points, double diameter_m)
    : tolerance_m_(static_cast<float>(kTolerancePerDiameter * diameter_m)) {
  const std::size_t stride = std::max<std::size_t>(1, (points.size() + kMostPoints - 1) / kMostPoints);
  for (std::size_t i = 0; i < points.size(); i += stride) {
    points_.push_back({points[i].point.cast<float>(), points[i].normal.cast<float>()});
  }
  // Neighbours in the list are neighbours on the object: the first few shall be from all over it.
  std::vector<Point> spread;
  constexpr std::size_t kApart = 5;
  for (std::size_t first = 0; first < kApart; ++first) {
    for (std::size_t i = first; i < points_.size(); i += kApart) spread.push_back(points_[i]);
  }
  points_ = spread;
}

void SparseFit::setImage(const DepthImageView& depth, const PinholeCamera& camera) {
  grid_ = makeSamplingGrid(camera, kSamplingFactor);
  depth_.resize(static_cast<std::size_t>(grid_.camera.width) * static_cast<std::size_t>(grid_.camera.height));
  std::size_t cell = 0;
  for (int row = 0; row < grid_.camera.height; ++row) {
    for (int col = 0; col < grid_.camera.width; ++col, ++cell) {
      const float z = depth.at(grid_.fullRow(row), grid_.fullCol(col));
      depth_[cell] = z > 0.0f ? z : 0.0f;
    }
  }
}

double SparseFit::match(const Pose& T_camera_centre) const {
  const Eigen::Matrix3f R = T_camera_centre.linear().cast<float>();
  const Eigen::Vector3f t = T_camera_centre.translation().cast<float>();
  const PinholeCamera& camera = grid_.camera;
  const auto fx = static_cast<float>(camera.fx), fy = static_cast<float>(camera.fy);
  const auto cx = static_cast<float>(camera.cx), cy = static_cast<float>(camera.cy);
  int facing = 0, matching = 0, through = 0;
  std::size_t looked_at = 0;
  for (const Point& point : points_) {
    constexpr std::size_t kFirstLook = 24;
    if (looked_at++ == kFirstLook && matching < through) break;  // most poses are nowhere near
    const Eigen::Vector3f p = R * point.point + t;
    constexpr float kLeastCosine = 0.25f;
    if ((R * point.normal).dot(p) > -kLeastCosine * p.norm()) continue;
    ++facing;
    if (!(p.z() > 0.05f)) continue;
    const float u = fx * p.x() / p.z() + cx + 0.5f, v = fy * p.y() / p.z() + cy + 0.5f;
    if (!(u >= 0.0f && u < static_cast<float>(camera.width) && v >= 0.0f && v < static_cast<float>(camera.height))) {
      continue;
    }
    const float z =
        depth_[static_cast<std::size_t>(v) * static_cast<std::size_t>(camera.width) + static_cast<std::size_t>(u)];
    if (!(z > 0.0f)) continue;
    const float beyond = z - p.z(), tolerance = tolerance_m_ + kNoisePerM * z * z;
    matching += beyond < tolerance && beyond > -tolerance ? 1 : 0;
    through += beyond >= tolerance ? 1 : 0;
  }
  return facing > 0 ? static_cast<double>(matching - through) / facing : -1.0;
}

}  // namespace depth_object_tracker
