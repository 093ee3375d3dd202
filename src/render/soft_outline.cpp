// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/render/soft_outline.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace depth_object_tracker {
namespace {

float coverageAt(double distance_px, double stddev_px) {
  return static_cast<float>(0.5 * std::erfc(-distance_px / stddev_px * M_SQRT1_2));
}

}  // namespace

const std::vector<SoftPixel>& SoftOutline::soften(const std::vector<CoveredPixel>& covered, const PinholeCamera& camera,
                                                  double edge_stddev_px) {
  soft_.clear();
  if (covered.empty()) return soft_;
  if (edge_stddev_px <= 0.0) {
    for (const CoveredPixel& pixel : covered)
      soft_.push_back({pixel.row, pixel.col, pixel.triangle, pixel.depth, 1.0f});
    return soft_;
  }
  markCovered(covered);
  closeImageBorder(camera);
  spread(covered);
  // The outline runs half a pixel from the centres of the pixels beside it.
  const float inside[] = {0.0f, coverageAt(0.5, edge_stddev_px), coverageAt(1.5, edge_stddev_px), 1.0f};
  const float outside[] = {0.0f, coverageAt(-0.5, edge_stddev_px), coverageAt(-1.5, edge_stddev_px)};
  constexpr float kNegligible = 1e-3f;
  for (int row = std::max(0, first_row_); row < std::min(camera.height, first_row_ + num_rows_); ++row) {
    for (int col = std::max(0, first_col_); col < std::min(camera.width, first_col_ + num_cols_); ++col) {
      const int level = level_[cell(row, col)];
      if (level == 0) continue;
      const float coverage = level > 0 ? inside[level] : outside[-level];
      if (coverage < kNegligible) continue;
      const CoveredPixel& from = covered[static_cast<std::size_t>(source_[cell(row, col)])];
      soft_.push_back({row, col, from.triangle, from.depth, coverage});
    }
  }
  return soft_;
}

float SoftOutline::distanceOf(std::int8_t level) {
  constexpr float kDistances[] = {-1.5f, -0.5f, -kFar, 0.5f, 1.5f, kFar, kFar};
  return kDistances[level + 2];
}

Eigen::Vector2f SoftOutline::outwardNormal(const SoftPixel& pixel) const {
  // Sobel operator on the distance, which falls towards the outside.
  const auto at = [&](int d_row, int d_col) { return distanceOf(level_[cell(pixel.row + d_row, pixel.col + d_col)]); };
  const float du = at(-1, 1) + 2.0f * at(0, 1) + at(1, 1) - at(-1, -1) - 2.0f * at(0, -1) - at(1, -1);
  const float dv = at(1, -1) + 2.0f * at(1, 0) + at(1, 1) - at(-1, -1) - 2.0f * at(-1, 0) - at(-1, 1);
  const Eigen::Vector2f normal(-du, -dv);
  const float norm = normal.norm();
  return norm > 1e-3f ? Eigen::Vector2f(normal / norm) : Eigen::Vector2f::Zero();
}

void SoftOutline::markCovered(const std::vector<CoveredPixel>& covered) {
  int min_col = covered.front().col, max_col = covered.front().col;
  for (const CoveredPixel& pixel : covered) {
    min_col = std::min(min_col, pixel.col);
    max_col = std::max(max_col, pixel.col);
  }
  constexpr int kMargin = kReach + 1;
  first_row_ = covered.front().row - kMargin;
  first_col_ = min_col - kMargin;
  num_rows_ = covered.back().row - covered.front().row + 1 + 2 * kMargin;
  num_cols_ = max_col - min_col + 1 + 2 * kMargin;
  const std::size_t num_cells = static_cast<std::size_t>(num_rows_) * static_cast<std::size_t>(num_cols_);
  level_.assign(num_cells, 0);
  source_.resize(num_cells);
  for (std::size_t i = 0; i < covered.size(); ++i) {
    const std::size_t index = cell(covered[i].row, covered[i].col);
    level_[index] = 3;
    source_[index] = static_cast<std::int32_t>(i);
  }
}

void SoftOutline::closeImageBorder(const PinholeCamera& camera) {
  // Beyond the image nothing is known: the object does not end there.
  constexpr std::int8_t kNoOutline = 4;
  for (int row = first_row_; row < first_row_ + num_rows_; ++row) {
    const bool row_outside = row < 0 || row >= camera.height;
    const int left = row_outside ? first_col_ + num_cols_ : std::max(first_col_, 0);
    const int right = row_outside ? left : std::min(first_col_ + num_cols_, camera.width);
    for (int col = first_col_; col < left; ++col) level_[cell(row, col)] = kNoOutline;
    for (int col = right; col < first_col_ + num_cols_; ++col) level_[cell(row, col)] = kNoOutline;
  }
}

void SoftOutline::spread(const std::vector<CoveredPixel>& covered) {
  const auto stride = static_cast<std::ptrdiff_t>(num_cols_);
  const std::array<std::ptrdiff_t, 4> neighbours = {-stride, -1, 1, stride};
  // First ring to either side of the outline.
  ring_.clear();
  for (const CoveredPixel& pixel : covered) {
    const std::size_t index = cell(pixel.row, pixel.col);
    for (const std::ptrdiff_t step : neighbours) {
      const std::size_t other = index + static_cast<std::size_t>(step);
      if (level_[other] > 0) continue;
      level_[index] = 1;
      if (level_[other] == 0) {
        level_[other] = -1;
        source_[other] = source_[index];
        ring_.push_back(other);
      }
    }
  }
  for (const std::size_t index : ring_) {
    for (const std::ptrdiff_t step : neighbours) {
      const std::size_t other = index + static_cast<std::size_t>(step);
      if (level_[other] != 0) continue;
      level_[other] = -2;
      source_[other] = source_[index];
    }
  }
  for (const CoveredPixel& pixel : covered) {
    const std::size_t index = cell(pixel.row, pixel.col);
    if (level_[index] != 3) continue;
    for (const std::ptrdiff_t step : neighbours) {
      if (level_[index + static_cast<std::size_t>(step)] == 1) level_[index] = 2;
    }
  }
}

}  // namespace depth_object_tracker
