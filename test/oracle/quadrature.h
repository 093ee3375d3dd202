// SPDX-License-Identifier: BSD-3-Clause
// Numerical integration for tests: composite Gauss-Legendre, open at the ends.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace depth_object_tracker {

/// Integral of f over [begin, end] with 5-point Gauss-Legendre in each of `panels` equal panels. Never evaluates the
/// ends.
template <typename Function>
double integrate(const Function& f, double begin, double end, int panels) {
  constexpr std::array<double, 3> kNodes = {0.0, 0.5384693101056831, 0.9061798459386640};
  constexpr std::array<double, 3> kWeights = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  const double half = 0.5 * (end - begin) / panels;
  double sum = 0.0;
  for (int panel = 0; panel < panels; ++panel) {
    const double middle = begin + half * (2 * panel + 1);
    sum += kWeights[0] * f(middle);
    for (std::size_t i = 1; i < kNodes.size(); ++i) {
      sum += kWeights[i] * (f(middle - half * kNodes[i]) + f(middle + half * kNodes[i]));
    }
  }
  return sum * half;
}

/// The same, piece by piece between sorted break points (where f jumps or changes fast).
template <typename Function>
double integratePieces(const Function& f, std::vector<double> breaks, int panels_per_piece) {
  std::sort(breaks.begin(), breaks.end());
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) sum += integrate(f, breaks[i], breaks[i + 1], panels_per_piece);
  return sum;
}

inline double normalDensity(double x, double mean, double stddev) {
  const double t = (x - mean) / stddev;
  return std::exp(-0.5 * t * t) / (stddev * std::sqrt(2.0 * M_PI));
}

}  // namespace depth_object_tracker
