// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/filter/random.h"

#include <Random123/philox.h>

#include <cmath>

namespace depth_object_tracker {
namespace {

using Generator = r123::Philox4x32;

Generator::ctr_type block(std::uint64_t seed, RandomPurpose purpose, std::uint64_t frame, std::uint32_t index,
                          std::uint32_t part) {
  const Generator::key_type key = {{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}};
  const Generator::ctr_type counter = {{static_cast<std::uint32_t>(frame), static_cast<std::uint32_t>(frame >> 32),
                                        index, static_cast<std::uint32_t>(purpose) * 16u + part}};
  return Generator()(counter, key);
}

/// Maps 32 random bits to the open interval (0, 1).
double toOpenUnit(std::uint32_t bits) {
  return (static_cast<double>(bits) + 0.5) * 0x1p-32;
}

}  // namespace

double CounterRandom::uniform(RandomPurpose purpose, std::uint64_t frame, std::uint32_t index) const {
  return toOpenUnit(block(seed_, purpose, frame, index, 15)[0]);
}

Vector6d CounterRandom::normal6(RandomPurpose purpose, std::uint64_t frame, std::uint32_t index) const {
  Vector6d result;
  for (std::uint32_t pair = 0; pair < 3; ++pair) {
    // Box-Muller: two uniforms to two normals.
    const Generator::ctr_type bits = block(seed_, purpose, frame, index, pair);
    const double radius = std::sqrt(-2.0 * std::log(toOpenUnit(bits[0])));
    const double angle = 2.0 * M_PI * toOpenUnit(bits[1]);
    const Eigen::Index first = 2 * static_cast<Eigen::Index>(pair);
    result[first] = radius * std::cos(angle);
    result[first + 1] = radius * std::sin(angle);
  }
  return result;
}

}  // namespace depth_object_tracker
