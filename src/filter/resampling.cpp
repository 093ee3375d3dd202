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

std::vector<int> resampleSystematic(const std::vector<double>& weights, double offset) {
  const int n = static_cast<int>(weights.size());
  std::vector<int> offspring(weights.size(), 0);
  double cumulative = 0.0;
  int drawn = 0;
  for (int i = 0; i < n; ++i) {
    cumulative += weights[static_cast<std::size_t>(i)] * n;
    while (drawn < n && offset + drawn < cumulative) {
      ++offspring[static_cast<std::size_t>(i)];
      ++drawn;
    }
  }
  // Rounding may leave the last point beyond the sum: it belongs to the last particle that has any weight.
  for (int i = n - 1; i >= 0 && drawn < n; --i) {
    if (weights[static_cast<std::size_t>(i)] <= 0.0) continue;
    offspring[static_cast<std::size_t>(i)] += n - drawn;
    drawn = n;
  }
  std::vector<int> source(weights.size());
  int parent = 0;
  for (int slot = 0; slot < n; ++slot) {
    if (offspring[static_cast<std::size_t>(slot)] > 0) {
      source[static_cast<std::size_t>(slot)] = slot;
      continue;
    }
    while (parent < n && offspring[static_cast<std::size_t>(parent)] < 2) ++parent;
    if (parent == n) break;
    source[static_cast<std::size_t>(slot)] = parent;
    --offspring[static_cast<std::size_t>(parent)];
  }
  return source;
}

}  // namespace depth_object_tracker
