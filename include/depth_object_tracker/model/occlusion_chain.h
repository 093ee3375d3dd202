// SPDX-License-Identifier: BSD-3-Clause
// Two-state Markov chain of a pixel's occlusion over any time step.
#pragma once

#include "depth_object_tracker/model/pixel_model_config.h"

namespace depth_object_tracker {

/// Exact chain: p(occluded) tends to `stationary` and its deviation from there decays by rate^dt.
class OcclusionChain {
 public:
  /// Probabilities per second in (0, 1), with p_visible_given_visible > p_visible_given_occluded.
  explicit OcclusionChain(const OcclusionChainConfig& config);

  double stationary() const { return stationary_; }

  /// Factor in (0, 1] by which deviations shrink within dt_s >= 0.
  double decay(double dt_s) const;

  /// p(occluded) dt_s later, without measurement.
  double predict(double p_occluded, double dt_s) const;

 private:
  double stationary_;
  double decay_per_second_;
};

}  // namespace depth_object_tracker
