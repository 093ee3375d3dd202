// SPDX-License-Identifier: BSD-3-Clause
// Weights of particles: normalisation, effective sample size, systematic resampling.
#pragma once

#include <vector>

namespace depth_object_tracker {

/// Turns log weights [nat] into weights that sum to 1; NaN and -Inf get weight 0.
/// @return log of the mean unnormalised weight [nat]; -Inf (and uniform weights) when no weight is positive.
double normaliseLogWeights(const std::vector<double>& log_weights, std::vector<double>& weights);

/// 1 / sum of squares, in [1, n] for weights that sum to 1; 0 for none.
double effectiveSampleSize(const std::vector<double>& weights);

/// Systematic resampling: particle i gets floor or ceil of n w_i offspring, n w_i in the mean.
/// Survivors keep their own slot, so that only the slots of the dead need to be written.
/// @param weights sum to 1. @param offset uniform in [0, 1). @param count n >= 1, number of slots.
/// @return for every slot the index of the particle that goes there.
std::vector<int> resampleSystematic(const std::vector<double>& weights, double offset, std::size_t count);

/// The same into `source`, which keeps its memory, as does `offspring` [scratch].
void resampleSystematic(const std::vector<double>& weights, double offset, std::size_t count,
                        std::vector<int>& offspring, std::vector<int>& source);

/// As many slots as particles.
inline std::vector<int> resampleSystematic(const std::vector<double>& weights, double offset) {
  return resampleSystematic(weights, offset, weights.size());
}

}  // namespace depth_object_tracker
