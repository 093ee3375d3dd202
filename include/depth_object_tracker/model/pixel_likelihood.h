// SPDX-License-Identifier: BSD-3-Clause
// The paper's measurement model of one pixel in closed form: the reference that faster code is tested against.
#pragma once

#include "depth_object_tracker/model/pixel_model_config.h"

namespace depth_object_tracker {

/// Depth noise of the camera, standard deviation [m], at measured depth z [m].
double cameraNoiseStddev(double measured_depth_m, const PixelModelConfig& config);

/// Standard deviation [m] of a reading of the object's surface: camera and mesh together.
double surfaceNoiseStddev(double measured_depth_m, const PixelModelConfig& config);

/// Rate of the occluders' exponential depth density [1/m]: ln 2 / half-life.
double occluderRate(const PixelModelConfig& config);

/// p(z | object visible at depth d) [1/m]: measurement and object noise integrated out, uniform tail.
/// @param measured_depth_m z in (0, max_depth_m); outside the density is 0 but for the Gaussian's own tails.
/// @param rendered_depth_m d > 0
double visibleDensity(double measured_depth_m, double rendered_depth_m, const PixelModelConfig& config);

/// p(z | object at depth d is occluded) [1/m].
/// kPaper: the occluder lies in front of the object; integrates to 1 (up to the variation of its normaliser over the
/// object noise: within 1 % for d >= 0.6 m, 3 % at 0.3 m). kConsistent: joint density of the reading and of "some
/// occluder is in front of d", for occluders that do not know of the object; its ratio to missDensity is a smoothed
/// step in (d - z), never above 1.
double occludedDensity(double measured_depth_m, double rendered_depth_m, const PixelModelConfig& config);

/// p(z | the beam does not meet the object) [1/m]: the limit of the occluded term for d -> infinity.
double missDensity(double measured_depth_m, const PixelModelConfig& config);

/// What one reading says about one pixel of a pose.
struct PixelUpdate {
  double log_ratio;   ///< [nat] log p(z | pose) - log p(z | no object), occlusion marginalised
  double p_occluded;  ///< posterior probability of occlusion
};

/// The paper's marginalisation over the pixel's occlusion and its posterior.
/// @param measured_depth_m non-finite or outside of (0, max_depth_m]: no reading, of which a visible object has fewer
/// than anything else (config.no_reading_ratio).
/// @param p_occluded prior in [0, 1], already moved forward in time.
PixelUpdate updatePixel(double measured_depth_m, double rendered_depth_m, double p_occluded,
                        const PixelModelConfig& config);

}  // namespace depth_object_tracker
