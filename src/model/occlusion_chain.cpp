// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/model/occlusion_chain.h"

#include <cmath>

namespace depth_object_tracker {

OcclusionChain::OcclusionChain(const OcclusionChainConfig& config) {
  // Transition matrix over one second with p_vv and p_vo: eigenvalues 1 and p_vv - p_vo.
  const double becomes_occluded = 1.0 - config.p_visible_given_visible;
  decay_per_second_ = config.p_visible_given_visible - config.p_visible_given_occluded;
  stationary_ = becomes_occluded / (becomes_occluded + config.p_visible_given_occluded);
}

double OcclusionChain::decay(double dt_s) const {
  return std::pow(decay_per_second_, dt_s);
}

double OcclusionChain::predict(double p_occluded, double dt_s) const {
  return stationary_ + (p_occluded - stationary_) * decay(dt_s);
}

}  // namespace depth_object_tracker
