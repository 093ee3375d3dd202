// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/filter/tile_fit.h"

#include <cstddef>

namespace depth_object_tracker {
namespace {

/// Sums over one row of a tile; no branches, for the compiler to vectorise.
struct RowSums {
  float covered = 0, matching = 0, through = 0, in_front = 0, beside = 0, continued = 0, behind = 0;

  void add(const float* depth, const float* soft_depth, const float* coverage, const float* measured, const float* peak,
           float tolerance_m, float tolerance_per_m) {
    constexpr float kFarthest = 1e6f;  // infinity where nothing was drawn
    for (int i = 0; i < kTileSize; ++i) {
      const float z = measured[i];
      const float has_reading = z > kMissingReadingM ? 1.0f : 0.0f;
      const float is_covered = depth[i] < kFarthest ? 1.0f : 0.0f;
      const float is_beside = coverage[i] > 0.0f ? 1.0f - is_covered : 0.0f;
      const float surface = is_covered > 0.0f ? depth[i] : is_beside > 0.0f ? soft_depth[i] : 0.0f;
      const float tolerance = tolerance_m + tolerance_per_m * z * z;
      const float too_far = z > surface + tolerance ? has_reading : 0.0f;
      const float too_near = z < surface - tolerance ? has_reading : 0.0f;
      const float on_surface = has_reading - too_far - too_near;
      const float same = peak[i] > kBackgroundPeak ? on_surface : 0.0f;
      const float taken = peak[i] > 0.0f ? 0.0f : on_surface;  // something else is seen there
      covered += is_covered;
      matching += is_covered * same;
      through += is_covered * too_far;
      in_front += is_covered * (too_near + taken);
      beside += is_beside * has_reading;
      continued += is_beside * same;
      behind += is_beside * too_far;
    }
  }
};

}  // namespace

TileFit countTileFit(const DepthTile& tile, const PixelPlanes& planes, float tolerance_m, float tolerance_per_m) {
  RowSums sums;
  for (int tile_row = 0; tile_row < tile.tile_rows; ++tile_row) {
    for (int tile_col = 0; tile_col < tile.tile_cols; ++tile_col) {
      const int index = tile_row * tile.tile_cols + tile_col;
      if (tile.touched[static_cast<std::size_t>(index)] == 0) continue;
      for (int row = tile_row * kTileSize; row < (tile_row + 1) * kTileSize; ++row) {
        const int cell = row * tile.stride + tile_col * kTileSize;
        const std::ptrdiff_t in_image = static_cast<std::ptrdiff_t>(tile.row_begin + row) * planes.stride +
                                        tile.col_begin + std::ptrdiff_t{kTileSize} * tile_col;
        sums.add(tile.depth() + cell, tile.softDepth() + cell, tile.coverage() + cell, planes.depth + in_image,
                 planes.visible_peak + in_image, tolerance_m, tolerance_per_m);
      }
    }
  }
  const auto count = [](float sum) { return static_cast<int>(sum + 0.5f); };
  return {count(sums.covered), count(sums.matching),  count(sums.through), count(sums.in_front),
          count(sums.beside),  count(sums.continued), count(sums.behind)};
}

}  // namespace depth_object_tracker
