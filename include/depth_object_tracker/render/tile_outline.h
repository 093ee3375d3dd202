// SPDX-License-Identifier: BSD-3-Clause
// Coverage of pixels near the object's outline: a depth camera does not know to the pixel where an edge is.
#pragma once

#include "depth_object_tracker/render/depth_tile.h"

namespace depth_object_tracker {

/// Probability that a beam meets the object, by its pixel's distance to the rendered outline: Phi(distance / stddev).
/// Without it the likelihood jumps by several nat whenever a pixel crosses the outline.
struct OutlineCoverage {
  /// @param edge_stddev_px in pixels of the rendered image; 0 = hard outline, the paper's.
  explicit OutlineCoverage(double edge_stddev_px);

  float edge_stddev_px;
  float inside[2];   ///< of covered pixels in the first and second ring from the outline
  float outside[2];  ///< of pixels beyond it
  int reach;         ///< rings to either side that are not 0 or 1 anyway: 0, 1 or 2
};

/// Turns the rendered depth into soft depth and coverage: `reach` pixels outside of the outline take the depth of the
/// nearest surface beside them. Beyond the image nothing is known: the object does not end there.
/// @param with_distance also the distance to the outline: +-0.5, +-1.5, or +-2.5 for all beyond.
void softenOutline(const OutlineCoverage& outline, bool with_distance, DepthTile& tile);
void softenOutlineScalar(const OutlineCoverage& outline, bool with_distance, DepthTile& tile);
void softenOutlineSimd(const OutlineCoverage& outline, bool with_distance, DepthTile& tile);

/// Whole tiles may reach beyond the image: nothing is covered there.
void clearRowsBeyondImage(DepthTile& tile);

/// Repeats the first and last cell of every row outwards.
void padRows(float* plane, const DepthTile& tile);

}  // namespace depth_object_tracker
