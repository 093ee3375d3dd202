// SPDX-License-Identifier: BSD-3-Clause
// Parameters of the per-pixel measurement model (the paper's section on the observation model).
#pragma once

namespace depth_object_tracker {

/// How an occluder's depth density is normalised.
enum class OccluderModel {
  kConsistent,  ///< occluders exist independently of the object: hiding never explains a pixel better than "no object"
  kPaper,       ///< the paper's: renormalised to lie in front of the object
};

struct PixelModelConfig {
  OccluderModel occluder_model = OccluderModel::kConsistent;
  double object_noise_stddev_m = 0.0015;  ///< sigma_m: how far the mesh is from the real surface; the paper: 0.003
  double depth_noise_per_m = 1.425e-3;    ///< sigma_c(z) = this * z^2 [1/m] (Khoshelham & Elberink 2012)
  double edge_stddev_px = 0.8;  ///< where the outline is seen, full-resolution pixels; 0 = to the pixel (the paper)
  double tail_weight = 0.01;    ///< beta: share of readings that are anything in (0, max_depth_m)
  double max_depth_m = 6.0;     ///< m: readings beyond are treated as missing
  double known_occluder_p_occluded = 0.95;  ///< prior behind a known occluder (a robot's link); 0 = they are ignored
  double known_occluder_margin_m = 0.03;    ///< how well its place is known: nearer to it nothing is behind it
  double min_p_occluded_in_front =
      0.8;  ///< p(occluded), at least, of readings far in front of the object; 0 = unused (the paper)
  /// p(no reading | object visible) / p(no reading | anything else); 1 = it says nothing (the paper). With kPaper
  /// unused.
  double no_reading_ratio = 0.3;
  double occluder_half_life_m = 1.0;  ///< depth over which the occluders' density halves
};

struct OcclusionChainConfig {
  double p_visible_given_visible = 0.9;   ///< over one second
  double p_visible_given_occluded = 0.3;  ///< over one second
  double initial_p_occluded = 0.25;       ///< p(o_0 = 1)
};

}  // namespace depth_object_tracker
