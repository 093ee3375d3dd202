// SPDX-License-Identifier: BSD-3-Clause
// The reference: rings by repeated dilation (least depth of the neighbours) and erosion (largest), infinity = not
// covered.
#include "depth_object_tracker/render/tile_outline.h"

#include "depth_object_tracker/geometry/simd_target.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depth_object_tracker {
namespace {

constexpr float kEmpty = std::numeric_limits<float>::infinity();

double normalCdf(double t) {
  return 0.5 * std::erfc(-t * M_SQRT1_2);
}

/// Of every cell and its four neighbours.
template <typename Combine>
void combineNeighbours(const float* from, float* to, const DepthTile& tile, const Combine& combine) {
  for (int row = 0; row < tile.rows; ++row) {
    const float* here = from + tile.rowOffset(row);
    const float* above = row > 0 ? here - tile.stride : here;
    const float* below = row + 1 < tile.rows ? here + tile.stride : here;
    for (int col = 0; col < tile.cols; ++col) {
      to[tile.rowOffset(row) + col] =
          combine(here[col], combine(combine(above[col], below[col]), combine(here[col - 1], here[col + 1])));
    }
  }
  padRows(to, tile);
}

float nearest(float a, float b) {
  return std::min(a, b);
}
float farthest(float a, float b) {
  return std::max(a, b);
}

}  // namespace

OutlineCoverage::OutlineCoverage(double stddev) : edge_stddev_px(static_cast<float>(stddev)) {
  constexpr double kNegligible = 1e-3;
  for (int ring = 0; ring < 2; ++ring) {
    const double share = stddev > 0.0 ? normalCdf((0.5 + ring) / stddev) : 1.0;
    inside[ring] = static_cast<float>(share);
    outside[ring] = static_cast<float>(1.0 - share);
  }
  reach = stddev <= 0.0 ? 0 : outside[1] < kNegligible ? 1 : 2;
  if (reach < 2) {
    inside[1] = 1.0f;
    outside[1] = 0.0f;
  }
}

void padRows(float* plane, const DepthTile& tile) {
  for (int row = 0; row < tile.rows; ++row) {
    float* cells = plane + tile.rowOffset(row);
    cells[-1] = cells[0];
    cells[tile.cols] = cells[tile.cols - 1];
  }
}

void clearRowsBeyondImage(DepthTile& tile) {
  for (int row = tile.rows; row < tile.tile_rows * kTileSize; ++row) {
    std::fill_n(tile.coverage() + tile.rowOffset(row), tile.tile_cols * kTileSize, 0.0f);
  }
}

void softenOutlineScalar(const OutlineCoverage& outline, bool with_distance, DepthTile& tile) {
  padRows(tile.depth(), tile);
  combineNeighbours(tile.depth(), tile.dilated(), tile, nearest);
  combineNeighbours(tile.depth(), tile.eroded(), tile, farthest);
  // The second rings take the place of soft depth and distance for a moment.
  float* dilated_twice = tile.softDepth();
  float* eroded_twice = tile.distance();
  combineNeighbours(tile.dilated(), dilated_twice, tile, nearest);
  combineNeighbours(tile.eroded(), eroded_twice, tile, farthest);
  for (int row = 0; row < tile.rows; ++row) {
    for (int col = 0; col < tile.cols; ++col) {
      const std::ptrdiff_t i = tile.rowOffset(row) + col;
      const bool covered = tile.depth()[i] < kEmpty;
      const bool inner = tile.eroded()[i] < kEmpty, innermost = eroded_twice[i] < kEmpty;
      const bool beside = tile.dilated()[i] < kEmpty, near = dilated_twice[i] < kEmpty;
      float coverage = 0.0f, distance = -2.5f;
      if (innermost) {
        coverage = 1.0f, distance = 2.5f;
      } else if (inner) {
        coverage = outline.inside[1], distance = 1.5f;
      } else if (covered) {
        coverage = outline.inside[0], distance = 0.5f;
      } else if (beside) {
        coverage = outline.outside[0], distance = -0.5f;
      } else if (near) {
        coverage = outline.outside[1], distance = -1.5f;
      }
      tile.coverage()[i] = coverage;
      tile.softDepth()[i] = covered ? tile.depth()[i] : beside ? tile.dilated()[i] : dilated_twice[i];
      tile.distance()[i] = distance;
      if (coverage > 0.0f) {
        const int index = row / kTileSize * tile.tile_cols + col / kTileSize;
        tile.touched[static_cast<std::size_t>(index)] = 1;
      }
    }
    for (int col = tile.cols; col < tile.tile_cols * kTileSize; ++col)
      tile.coverage()[tile.rowOffset(row) + col] = 0.0f;
  }
  clearRowsBeyondImage(tile);
  if (with_distance) padRows(tile.distance(), tile);
}

void softenOutline(const OutlineCoverage& outline, bool with_distance, DepthTile& tile) {
#ifdef DEPTH_OBJECT_TRACKER_HAVE_HIGHWAY
  if (!simdIsScalar()) return softenOutlineSimd(outline, with_distance, tile);
#endif
  softenOutlineScalar(outline, with_distance, tile);
}

}  // namespace depth_object_tracker
