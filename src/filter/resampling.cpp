// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/filter/resampling.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depth_object_tracker {

double normaliseLogWeights(const std::vector<double>& log_weights, std::vector<double>& weights) {
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  weights.assign(log_weights.size(), 0.0);
  if (log_weights.empty()) return kNone;
  double largest = kNone;
  for (double log_weight : log_weights) {
    if (std::isfinite(log_weight)) largest = std::max(largest, log_weight);
  }
  const double count = static_cast<double>(log_weights.size());
  if (largest == kNone) {
    std::fill(weights.begin(), weights.end(), 1.0 / count);
    return kNone;
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (std::isfinite(log_weights[i])) weights[i] = std::exp(log_weights[i] - largest);
    sum += weights[i];
  }
  for (double& weight : weights) weight /= sum;
  return largest + std::log(sum / count);
}

double effectiveSampleSize(const std::vector<double>& weights) {
  double sum_of_squares = 0.0;
  for (double weight : weights) sum_of_squares += weight * weight;
  return sum_of_squares > 0.0 ? 1.0 / sum_of_squares : 0.0;
}

std::vector<int> resampleSystematic(const std::vector<double>& weights, double offset, std::size_t count) {
  std::vector<int> offspring, source;
  resampleSystematic(weights, offset, count, offspring, source);
  return source;
}

void resampleSystematic(const std::vector<double>& weights, double offset, std::size_t count,
                        std::vector<int>& offspring, std::vector<int>& source) {
  const std::size_t num_particles = weights.size();
  offspring.assign(num_particles, 0);
  double cumulative = 0.0;
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < num_particles; ++i) {
    cumulative += weights[i] * static_cast<double>(count);
    while (drawn < count && offset + static_cast<double>(drawn) < cumulative) {
      ++offspring[i];
      ++drawn;
    }
  }
  // Rounding may leave the last point beyond the sum: it belongs to the last particle that has any weight.
  for (std::size_t i = num_particles; i-- > 0 && drawn < count;) {
    if (weights[i] <= 0.0) continue;
    offspring[i] += static_cast<int>(count - drawn);
    drawn = count;
  }
  constexpr int kNobody = -1;
  source.assign(num_particles == 0 ? 0 : count, kNobody);
  for (std::size_t slot = 0; slot < std::min(source.size(), num_particles); ++slot) {
    if (offspring[slot] == 0) continue;
    source[slot] = static_cast<int>(slot);
    --offspring[slot];
  }
  std::size_t parent = 0;
  for (int& from : source) {
    if (from != kNobody) continue;
    while (parent < num_particles && offspring[parent] == 0) ++parent;
    if (parent == num_particles) break;
    from = static_cast<int>(parent);
    --offspring[parent];
  }
}

}  // namespace depth_object_tracker
