// SPDX-License-Identifier: BSD-3-Clause
// Coverage of pixels near the object's outline: a depth camera does not know to the pixel where an edge is.
#pragma once

#include "depth_object_tracker/render/depth_renderer.h"

#include <cstdint>
#include <vector>

namespace depth_object_tracker {

/// A pixel that the object may cover.
struct SoftPixel {
  std::int32_t row;
  std::int32_t col;
  std::uint32_t triangle;
  float depth;     ///< [m]; outside of the outline that of the nearest covered pixel
  float coverage;  ///< probability that the beam meets the object, (0, 1]; >= 0.5 inside of the outline
};

/// Turns rendered pixels into pixels with coverage Phi(distance to the outline / edge_stddev), two pixels to either
/// side. Without it the likelihood jumps by several nat whenever a pixel crosses the outline. Holds scratch memory: one
/// per thread.
class SoftOutline {
 public:
  /// @param edge_stddev_px in pixels of the rendered image; 0 = hard outline, the paper's.
  const std::vector<SoftPixel>& soften(const std::vector<CoveredPixel>& covered, const PinholeCamera& camera,
                                       double edge_stddev_px);

  /// Of the pixels that soften() returned last: distance [px] to the outline, positive inside; +-0.5, +-1.5, or kFar.
  float distance(const SoftPixel& pixel) const { return distanceOf(level_[cell(pixel.row, pixel.col)]); }
  /// ... and the image direction (u, v) that leads out of the object; zero where it is not defined. Only near the
  /// outline.
  Eigen::Vector2f outwardNormal(const SoftPixel& pixel) const;

  static constexpr float kFar = 2.5f;

 private:
  static float distanceOf(std::int8_t level);

  static constexpr int kReach = 2;  // pixels to either side of the outline

  void markCovered(const std::vector<CoveredPixel>& covered);
  void closeImageBorder(const PinholeCamera& camera);
  void spread(const std::vector<CoveredPixel>& covered);
  std::size_t cell(int row, int col) const {
    return static_cast<std::size_t>(row - first_row_) * static_cast<std::size_t>(num_cols_) +
           static_cast<std::size_t>(col - first_col_);
  }

  int first_row_ = 0, first_col_ = 0, num_rows_ = 0, num_cols_ = 0;  // box with a margin of kReach + 1
  std::vector<std::int8_t> level_;    // distance to the outline in pixels: 3 = inside, 2, 1 | -1, -2, 0 = far outside
  std::vector<std::int32_t> source_;  // index of the covered pixel that depth comes from
  std::vector<std::size_t> ring_;     // cells just outside of the outline
  std::vector<SoftPixel> soft_;
};

}  // namespace depth_object_tracker
