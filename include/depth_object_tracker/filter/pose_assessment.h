// SPDX-License-Identifier: BSD-3-Clause
// How well one pose explains an image, counted pixel by pixel: what the tracker's status and its searches judge by.
#pragma once

#include "depth_object_tracker/filter/tile_likelihood.h"
#include "depth_object_tracker/model/measured_image.h"
#include "depth_object_tracker/render/depth_tile.h"

namespace depth_object_tracker {

/// How well one pose explains the frame, pixel by pixel.
struct PoseAssessment {
  int covered_pixels = 0;
  int measured_pixels = 0;      ///< ... of which with a depth reading
  double visible_pixels = 0.0;  ///< expected number of measured pixels where the object is visible
  double log_likelihood = 0.0;  ///< [nat]
  double achieved = 0.0;        ///< log ratio [nat] summed with the pixels' probability not to be occluded
  double expected = 0.0;        ///< ... and what the sensor model expects of it at the true pose
  int through_pixels = 0;       ///< measured pixels with a reading clearly behind the object
  int surrounding_pixels = 0;   ///< measured pixels just outside of the outline
  int continued_pixels = 0;     ///< ... of which with a reading that carries on the surface beside them
  int beyond_pixels = 0;        ///< ... of which with a reading clearly behind: the object ends there
  // Only after assessHiddenEdges():
  int hidden_edges = 0;   ///< neighbouring pixels, the object seen in one and hidden in the other
  int merging_edges = 0;  ///< ... of which without a step between their readings: what hides carries on what is seen

  /// Of the object, in [0, 1]: where most of it has no reading little is seen of it, however well the rest fits.
  double visibleShare() const;
};

/// @param tile the object, rendered at the pose.
/// @param image prepared where the tile lies. @param input of the same image.
/// @param tile_beliefs as in tileLogLikelihood(). @param extra_stddev_m [m] >= 0 widens the surface noise.
PoseAssessment assessTile(const DepthTile& tile, const MeasuredImage& image, const TileLikelihoodInput& input,
                          const float* const* tile_beliefs, float extra_stddev_m);

/// Counts where what is seen of the object meets what hides it. @param tile and @param image as above.
void assessHiddenEdges(const DepthTile& tile, const MeasuredImage& image, PoseAssessment& assessment);

}  // namespace depth_object_tracker
