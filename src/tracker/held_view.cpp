// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/held_view.h"

#include <algorithm>
#include <limits>

namespace depth_object_tracker {
namespace {

constexpr double kLeastHiddenShare = 0.7, kMostHiddenShare = 0.97;
constexpr double kStillHiddenShare = 0.6;  // once it was more, and of an object that was never seen
constexpr int kBesideCells = 6;            // what hides the object goes on beside its outline
constexpr double kLeastShareBeside = 0.4;  // of the cells there
constexpr float kNowhere = std::numeric_limits<float>::infinity();

std::size_t cell(int row, int col, const PinholeCamera& camera) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(camera.width) + static_cast<std::size_t>(col);
}

/// Of cells with a reading.
struct Count {
  int measured = 0, nearer = 0;
  void add(float depth_m, float limit_m) {
    measured += depth_m > 0.0f ? 1 : 0;
    nearer += depth_m > 0.0f && depth_m < limit_m ? 1 : 0;
  }
};

}  // namespace

bool HeldView::hidesMuch(const std::vector<CoveredPixel>& covered, const DepthImageView& depth,
                         const SamplingGrid& grid, double reach_m) const {
  const auto reach = static_cast<float>(reach_m);
  int measured = 0, hidden = 0;
  for (const CoveredPixel& pixel : covered) {
    const float z = depth.at(grid.fullRow(pixel.row), grid.fullCol(pixel.col));
    measured += z > 0.0f ? 1 : 0;
    hidden += z < pixel.depth - reach ? 1 : 0;
  }
  const double least = foreign_.empty() ? kLeastHiddenShare : kStillHiddenShare;
  return hidden > least * measured && hidden < kMostHiddenShare * measured;
}

/// The object's depth, and beside it the nearest that it has thereabouts.
void HeldView::expect(const std::vector<CoveredPixel>& covered, const PinholeCamera& camera) {
  expected_.assign(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height), kNowhere);
  for (const CoveredPixel& pixel : covered) {
    const int row_end = std::min(camera.height, pixel.row + kBesideCells + 1);
    const int col_end = std::min(camera.width, pixel.col + kBesideCells + 1);
    for (int row = std::max(0, pixel.row - kBesideCells); row < row_end; ++row) {
      for (int col = std::max(0, pixel.col - kBesideCells); col < col_end; ++col) {
        float& expected = expected_[cell(row, col, camera)];
        expected = std::min(expected, pixel.depth);
      }
    }
  }
  for (const CoveredPixel& pixel : covered) expected_[cell(pixel.row, pixel.col, camera)] = pixel.depth;
}

const std::vector<float>& HeldView::foreignReadings(const DepthImageView& depth, const SamplingGrid& grid,
                                                    const Pose& T_camera_object, double reach_m) {
  const std::vector<CoveredPixel>& covered = renderer_.render(T_camera_object, grid.camera);
  if (!hidesMuch(covered, depth, grid, reach_m)) {
    foreign_.clear();
  } else {
    keepNearer(covered, depth, grid, reach_m);
  }
  return foreign_;
}

const std::vector<float>& HeldView::nearerReadings(const DepthImageView& depth, const SamplingGrid& grid,
                                                   const Pose& T_camera_object, double reach_m) {
  keepNearer(renderer_.render(T_camera_object, grid.camera), depth, grid, reach_m);
  return foreign_;
}

void HeldView::keepNearer(const std::vector<CoveredPixel>& covered, const DepthImageView& depth,
                          const SamplingGrid& grid, double reach_m) {
  expect(covered, grid.camera);
  foreign_.assign(expected_.size(), 0.0f);
  for (int row = 0; row < grid.camera.height; ++row) {
    for (int col = 0; col < grid.camera.width; ++col) {
      const std::size_t i = cell(row, col, grid.camera);
      if (expected_[i] == kNowhere) continue;
      const float z = depth.at(grid.fullRow(row), grid.fullCol(col));
      if (z < expected_[i] - static_cast<float>(reach_m)) foreign_[i] = z;
    }
  }
}

bool HeldView::isHidden(const DepthImageView& depth, const SamplingGrid& grid, const Pose& T_camera_object,
                        double reach_m) {
  const std::vector<CoveredPixel>& covered = renderer_.render(T_camera_object, grid.camera);
  expect(covered, grid.camera);
  const auto reach = static_cast<float>(reach_m);
  Count on, all;
  for (const CoveredPixel& pixel : covered) {
    on.add(depth.at(grid.fullRow(pixel.row), grid.fullCol(pixel.col)), pixel.depth - reach);
  }
  for (int row = 0; row < grid.camera.height; ++row) {
    for (int col = 0; col < grid.camera.width; ++col) {
      const float expected = expected_[cell(row, col, grid.camera)];
      if (expected != kNowhere) all.add(depth.at(grid.fullRow(row), grid.fullCol(col)), expected - reach);
    }
  }
  return on.nearer > kStillHiddenShare * on.measured &&
         all.nearer - on.nearer > kLeastShareBeside * (all.measured - on.measured);
}

}  // namespace depth_object_tracker
