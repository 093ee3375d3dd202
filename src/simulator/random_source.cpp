// SPDX-License-Identifier: BSD-3-Clause
// Seeded random numbers: the engine is fixed by the C++ standard, the transforms are here.
#include "depth_object_tracker/simulator/random_source.h"

#include <cmath>

namespace depth_object_tracker {
namespace {

// Finaliser of splitmix64: neighbouring seeds and streams give unrelated engines.
std::uint64_t mix(std::uint64_t value) {
  value += 0x9e3779b97f4a7c15ULL;
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9ULL;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebULL;
  return value ^ (value >> 31);
}

}  // namespace

RandomSource::RandomSource(std::uint64_t seed, std::uint64_t stream) : engine_(mix(mix(seed) + stream)) {}

double RandomSource::normal() {
  // Box-Muller; only one of the pair is used, so a draw does not depend on what was drawn before.
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  return radius * std::cos(2.0 * M_PI * uniform());
}

Eigen::Vector3d RandomSource::unitVector() {
  const double z = uniform(-1.0, 1.0);
  const double angle = uniform(0.0, 2.0 * M_PI);
  const double radius = std::sqrt(1.0 - z * z);
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

}  // namespace depth_object_tracker
