// SPDX-License-Identifier: BSD-3-Clause
// Counter-based random numbers: a draw depends on (seed, frame, index, purpose) and on nothing else, so results do not
// depend on the number of threads or on the order of calls.
#pragma once

#include "depth_object_tracker/geometry/pose.h"

#include <cstdint>

namespace depth_object_tracker {

/// What a draw is for; keeps streams apart.
enum class RandomPurpose : std::uint32_t {
  kInitialPose = 1,
  kProposal = 2,
  kComponent = 3,
  kResampling = 4,
  kSearch = 5
};

class CounterRandom {
 public:
  explicit CounterRandom(std::uint64_t seed) : seed_(seed) {}

  /// Uniform in (0, 1).
  double uniform(RandomPurpose purpose, std::uint64_t frame, std::uint32_t index) const;

  /// Six independent standard normal numbers.
  Vector6d normal6(RandomPurpose purpose, std::uint64_t frame, std::uint32_t index) const;

 private:
  std::uint64_t seed_;
};

}  // namespace depth_object_tracker
