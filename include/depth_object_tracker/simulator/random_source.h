// SPDX-License-Identifier: BSD-3-Clause
// Seeded random numbers that are the same with every standard library (its distributions are not).
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <random>

namespace depth_object_tracker {

/// One reproducible stream. Streams of one seed are independent of each other.
class RandomSource {
 public:
  explicit RandomSource(std::uint64_t seed, std::uint64_t stream = 0);

  std::uint64_t bits() { return engine_(); }
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }  ///< [0, 1)
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  double normal();  ///< mean 0, standard deviation 1
  Eigen::Vector3d normalVector() { return {normal(), normal(), normal()}; }
  Eigen::Vector3d unitVector();  ///< uniform on the sphere

 private:
  std::mt19937_64 engine_;
};

}  // namespace depth_object_tracker
