// SPDX-License-Identifier: BSD-3-Clause
// Tabulated exp(-t^2/2) and standard normal distribution function for the hot loop.
#pragma once

#include <array>
#include <cmath>

namespace depth_object_tracker {

/// Linear interpolation between nodes 1/128 apart on [-8, 8]: absolute error below 1e-5, exact limits outside.
class NormalTable {
 public:
  static const NormalTable& instance() {
    static const NormalTable table;
    return table;
  }

  float bell(float t) const { return interpolate(bell_, std::fabs(t)); }

  /// Phi(t), by symmetry from its upper half.
  float cdf(float t) const {
    const float upper_tail = interpolate(tail_, std::fabs(t));
    return t >= 0.0f ? 1.0f - upper_tail : upper_tail;
  }

 private:
  static constexpr int kNodesPerUnit = 128;
  static constexpr int kRange = 8;
  using Nodes = std::array<float, kNodesPerUnit * kRange + 2>;

  NormalTable() {
    for (std::size_t i = 0; i < bell_.size(); ++i) {
      const double t = static_cast<double>(i) / kNodesPerUnit;
      bell_[i] = static_cast<float>(std::exp(-0.5 * t * t));
      tail_[i] = static_cast<float>(0.5 * std::erfc(t * M_SQRT1_2));
    }
  }

  static float interpolate(const Nodes& nodes, float magnitude) {
    const float position = magnitude * kNodesPerUnit;
    if (!(position < kNodesPerUnit * kRange)) return 0.0f;
    const int index = static_cast<int>(position);
    const float share = position - static_cast<float>(index);
    const auto node = static_cast<std::size_t>(index);
    return nodes[node] + share * (nodes[node + 1] - nodes[node]);
  }

  Nodes bell_, tail_;
};

}  // namespace depth_object_tracker
