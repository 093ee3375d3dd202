// SPDX-License-Identifier: BSD-3-Clause
// Parameters of the Rao-Blackwellised particle filter.
#pragma once

#include <cstdint>

namespace depth_object_tracker {

enum class Proposal {
  kInformed,  ///< product of each particle's process prior with a Gauss-Newton fit of the frame's likelihood
  kProcess,   ///< the paper's bootstrap: draw from the process model alone
};

struct FilterConfig {
  Proposal proposal = Proposal::kInformed;
  int num_particles = 70;
  double prior_share = 0.2;           ///< informed: share of particles that still draw from the process model alone
  double likelihood_exponent = 0.0;   ///< gamma; 0 = chosen from the sampling factor (see likelihoodExponent)
  double resampling_threshold = 0.5;  ///< resample when the effective share of particles is below; 1 = every frame
  std::uint64_t seed = 1;
  bool smooth_estimate = true;  ///< the published pose is averaged over images, see PoseSmoother; false = the paper
  int num_threads = 1;
};

}  // namespace depth_object_tracker
