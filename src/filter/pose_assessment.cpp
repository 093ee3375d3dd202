// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/filter/pose_assessment.h"

#include "depth_object_tracker/model/pixel_likelihood.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depth_object_tracker {
namespace {

MeasuredPixel broadened(MeasuredPixel pixel, float extra_stddev_m) {
  if (extra_stddev_m <= 0.0f || !pixel.hasReading()) return pixel;
  const float shrink = 1.0f / std::hypot(1.0f, extra_stddev_m * pixel.inverse_stddev);
  pixel.inverse_stddev *= shrink;
  if (pixel.visible_peak > kBackgroundPeak) pixel.visible_peak *= shrink;
  return pixel;
}

/// What is seen at a depth is there without the object as well: it speaks neither for it nor against it.
bool isBackgroundAt(const MeasuredPixel& pixel, float depth) {
  constexpr float kSameStddevs = 4.0f;
  return pixel.visible_peak <= kBackgroundPeak && std::abs(pixel.depth - depth) * pixel.inverse_stddev < kSameStddevs;
}

/// Adds what one covered pixel with a reading says about how well a pose fits.
void assessPixel(const MeasuredPixel& pixel, float depth, float coverage, float p_occluded, const PixelModel& model,
                 PoseAssessment& sum) {
  if (isBackgroundAt(pixel, depth)) return;
  const PixelRatios ratios = pixelRatios(model, pixel, depth);
  const float visible = (1.0f - p_occluded) * ratios.visible, occluded = p_occluded * ratios.occluded;
  const float total = (1.0f - coverage) + coverage * (visible + occluded);
  const double not_occluded = visible / (visible + occluded);
  constexpr float kThroughStddevs = 6.0f;
  ++sum.measured_pixels;
  sum.through_pixels += (pixel.depth - depth) * pixel.inverse_stddev > kThroughStddevs ? 1 : 0;
  if (pixel.visible_peak <= 0.0f) return;  // something else is seen there
  sum.visible_pixels += (1.0f - p_occluded) * ratios.surface / (visible + occluded);
  sum.achieved += not_occluded * std::log(total);
  // A visible pixel's log density has the mean of a Gaussian's: half a nat below its peak.
  const double peak = (1.0f - p_occluded) * pixel.visible_peak;
  sum.expected += not_occluded * (std::log(1.0 + coverage * (peak - 1.0)) - 0.5);
}

/// A table or board that is taken for one of the object's faces goes on beyond the outline; an object ends there.
void assessSurroundings(const MeasuredPixel& pixel, float surface_depth, PoseAssessment& sum) {
  constexpr float kSameSurfaceStddevs = 4.0f;
  if (isBackgroundAt(pixel, surface_depth)) return;
  ++sum.surrounding_pixels;
  const float offset = (pixel.depth - surface_depth) * pixel.inverse_stddev;
  if (std::abs(offset) < kSameSurfaceStddevs) ++sum.continued_pixels;
  if (offset >= kSameSurfaceStddevs) ++sum.beyond_pixels;
}

/// Where a surface is seen, and whether that is the object's, or hides it.
struct SeenSurface {
  float depth = 0.0f;      ///< reading [m]; 0 = says nothing
  bool is_object = false;  ///< else it hides the object
};

SeenSurface seenSurface(const MeasuredPixel& pixel, float object_depth) {
  constexpr float kSameStddevs = 3.0f, kHiddenStddevs = 5.0f;
  const float in_front = (object_depth - pixel.depth) * pixel.inverse_stddev;
  if (!pixel.hasReading() || in_front < -kSameStddevs) return {};
  if (in_front > kHiddenStddevs) return {pixel.depth, false};
  return in_front < kSameStddevs ? SeenSurface{pixel.depth, true} : SeenSurface{};
}

/// What hides a part of the object stands before it. A board that is taken for one of its faces does not: the rest of
/// the object would be behind the same board.
void assessEdge(const SeenSurface& a, const SeenSurface& b, float largest_step_m, PoseAssessment& sum) {
  if (a.depth <= 0.0f || b.depth <= 0.0f || a.is_object == b.is_object) return;
  ++sum.hidden_edges;
  if (std::abs(a.depth - b.depth) < largest_step_m) ++sum.merging_edges;
}

float believedOcclusionAt(int row, int col, const DepthTile& tile, const TileLikelihoodInput& input,
                          const float* const* tile_beliefs, const MeasuredPixel& pixel) {
  const float* beliefs = tile_beliefs[row / kTileSize * tile.tile_cols + col / kTileSize];
  const float stored =
      beliefs != nullptr ? beliefs[row % kTileSize * kTileSize + col % kTileSize] : input.belief.unmeasured;
  const float p_occluded = input.belief.stationary + input.belief.scale * stored;
  return believedOcclusion(input.model, p_occluded, pixel, tile.depth()[row * tile.stride + col]);
}

/// Pixels that the object covers, and those just outside of its outline.
void assessPixels(const DepthTile& tile, const MeasuredImage& image, const TileLikelihoodInput& input,
                  const float* const* tile_beliefs, float extra_stddev_m, PoseAssessment& sum) {
  for (int row = 0; row < tile.rows; ++row) {
    for (int col = 0; col < tile.cols; ++col) {
      const int cell = row * tile.stride + col;
      const float depth = tile.depth()[cell], coverage = tile.coverage()[cell];
      if (!(coverage > 0.0f)) continue;
      const bool is_covered = depth < std::numeric_limits<float>::infinity();
      sum.covered_pixels += is_covered ? 1 : 0;
      const MeasuredPixel pixel = broadened(image.pixel(tile.row_begin + row, tile.col_begin + col), extra_stddev_m);
      if (!pixel.hasReading()) continue;
      if (is_covered) {
        assessPixel(pixel, depth, coverage, believedOcclusionAt(row, col, tile, input, tile_beliefs, pixel),
                    input.model, sum);
      } else {
        assessSurroundings(pixel, tile.softDepth()[cell], sum);
      }
    }
  }
}

}  // namespace

double PoseAssessment::visibleShare() const {
  constexpr double kUsuallyMeasured = 0.5;  // dark and steep surfaces have fewer readings
  const double of = std::max<double>(measured_pixels, kUsuallyMeasured * covered_pixels);
  return of > 0.0 ? std::min(1.0, visible_pixels / of) : 0.0;
}

PoseAssessment assessTile(const DepthTile& tile, const MeasuredImage& image, const TileLikelihoodInput& input,
                          const float* const* tile_beliefs, float extra_stddev_m) {
  PoseAssessment result;
  result.log_likelihood = tileLogLikelihood(tile, input, tile_beliefs, extra_stddev_m);
  assessPixels(tile, image, input, tile_beliefs, extra_stddev_m, result);
  return result;
}

void assessHiddenEdges(const DepthTile& tile, const MeasuredImage& image, PoseAssessment& assessment) {
  constexpr float kSteepest = 1.5f, kNoiseStddevs = 4.0f;
  const auto surface = [&](int row, int col) {
    if (row < 0 || col < 0) return SeenSurface();
    const int small_tile = row / kTileSize * tile.tile_cols + col / kTileSize;
    if (tile.touched[static_cast<std::size_t>(small_tile)] == 0) return SeenSurface();
    const float depth = tile.depth()[row * tile.stride + col];
    if (!(depth < std::numeric_limits<float>::infinity())) return SeenSurface();
    return seenSurface(image.pixel(tile.row_begin + row, tile.col_begin + col), depth);
  };
  const auto focal_px = static_cast<float>(image.grid().camera.fx);
  const auto noise_per_m = static_cast<float>(image.config().depth_noise_per_m);
  for (int row = 0; row < tile.rows; ++row) {
    for (int col = 0; col < tile.cols; ++col) {
      const SeenSurface here = surface(row, col);
      if (here.depth <= 0.0f) continue;
      const float noise_m = noise_per_m * here.depth * here.depth;
      const float largest_step_m = kSteepest * here.depth / focal_px + kNoiseStddevs * noise_m;
      assessEdge(here, surface(row, col - 1), largest_step_m, assessment);
      assessEdge(here, surface(row - 1, col), largest_step_m, assessment);
    }
  }
}

}  // namespace depth_object_tracker
