// SPDX-License-Identifier: BSD-3-Clause
// k-d tree over a fixed set of points.
#include "depth_object_tracker/tools/nearest_point_index.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depth_object_tracker {
namespace {

constexpr std::size_t kLeafSize = 12;

}  // namespace

NearestPointIndex::NearestPointIndex(std::vector<Eigen::Vector3f> points)
    : points_(std::move(points)), split_axis_(points_.size(), 0) {
  build(0, points_.size());
}

void NearestPointIndex::build(std::size_t begin, std::size_t end) {
  if (end - begin <= kLeafSize) return;
  Eigen::Vector3f low = points_[begin];
  Eigen::Vector3f high = points_[begin];
  for (std::size_t i = begin; i < end; ++i) {
    low = low.cwiseMin(points_[i]);
    high = high.cwiseMax(points_[i]);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [this](std::size_t i) { return points_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end),
                   [axis](const Eigen::Vector3f& a, const Eigen::Vector3f& b) { return a[axis] < b[axis]; });
  split_axis_[middle] = static_cast<std::uint8_t>(axis);
  build(begin, middle);
  build(middle + 1, end);
}

void NearestPointIndex::search(std::size_t begin, std::size_t end, const Eigen::Vector3f& query,
                               float& best_squared) const {
  if (end - begin <= kLeafSize) {
    for (std::size_t i = begin; i < end; ++i) best_squared = std::min(best_squared, (points_[i] - query).squaredNorm());
    return;
  }
  const std::size_t middle = begin + (end - begin) / 2;
  best_squared = std::min(best_squared, (points_[middle] - query).squaredNorm());
  const int axis = split_axis_[middle];
  const float beyond = query[axis] - points_[middle][axis];
  const bool left_first = beyond < 0.0f;
  left_first ? search(begin, middle, query, best_squared) : search(middle + 1, end, query, best_squared);
  if (beyond * beyond >= best_squared) return;
  left_first ? search(middle + 1, end, query, best_squared) : search(begin, middle, query, best_squared);
}

float NearestPointIndex::distance(const Eigen::Vector3f& query) const {
  float best_squared = std::numeric_limits<float>::max();
  search(0, points_.size(), query, best_squared);
  return std::sqrt(best_squared);
}

}  // namespace depth_object_tracker
