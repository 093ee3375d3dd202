// SPDX-License-Identifier: BSD-3-Clause
// Measurements along one axis, and the filter over them without particles: densities on a fine grid.
#pragma once

#include "quadrature.h"
#include "toy_likelihood.h"

#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace depth_object_tracker {

/// A log-likelihood along x and its local model there.
struct AlongX {
  const char* name;
  std::function<double(double)> log_likelihood;
  std::function<Eigen::Vector2d(double)> slope_and_information;
};

inline double logGaussian(double x, double mean, double stddev) {
  return std::log(normalDensity(x, mean, stddev));
}

inline AlongX gaussianAlongX(double shift_of_model = 0.0, double over_confidence = 1.0) {
  const double mean = 0.004, stddev = 0.003;
  return {"Gaussian", [=](double x) { return logGaussian(x, mean, stddev); },
          [=](double x) {
            const double information = over_confidence / (stddev * stddev);
            return Eigen::Vector2d(information * (mean + shift_of_model - x), information);
          }};
}

inline AlongX bimodalAlongX() {
  const auto parts = [](double x) {
    return std::make_pair(0.7 * normalDensity(x, -0.007, 0.0015), 0.3 * normalDensity(x, 0.006, 0.001));
  };
  return {"bimodal", [=](double x) { return std::log(parts(x).first + parts(x).second + 1e-9); },
          [=](double x) {
            const auto [left, right] = parts(x);
            const double share = left / (left + right + 1e-9), left_information = 1.0 / 2.25e-6,
                         right_information = 1e6;
            return Eigen::Vector2d(
                share * left_information * (-0.007 - x) + (1.0 - share) * right_information * (0.006 - x),
                share * left_information + (1.0 - share) * right_information);
          }};
}

inline AlongX asymmetricAlongX() {
  return {
      "asymmetric", [](double x) { return x < 0.0 ? -0.5 * x * x / 1e-6 : -x / 0.004; },
      [](double x) { return x < 0.0 ? Eigen::Vector2d(-x / 1e-6, 1e6) : Eigen::Vector2d(-1.0 / 0.004, 1.0 / 1.6e-5); }};
}

inline ToyLikelihood toyOf(const AlongX& model) {
  return {[=](const Vector6d& x) { return model.log_likelihood(x[0]); },
          [=](const Vector6d& x) {
            const Eigen::Vector2d local = model.slope_and_information(x[0]);
            Linearisation result;
            result.gradient[0] = local[0];
            result.information(0, 0) = local[1];
            return result;
          }};
}

/// Belief along x on a fine grid: what a filter should say.
class GridFilter {
 public:
  GridFilter() : belief_(kCells, 0.0) { belief_[kCells / 2] = 1.0; }

  void predict(const ProcessStep& step) {
    std::vector<double> kernel(2 * kCells + 1, 0.0);
    for (int k = 0; k < step.numComponents(); ++k) {
      const double stddev = std::sqrt(step.component(k).variances[0]);
      for (int i = -kCells; i <= kCells; ++i) {
        kernel[static_cast<std::size_t>(i + kCells)] +=
            step.component(k).weight * normalDensity(i * kCellM, 0.0, stddev) * kCellM;
      }
    }
    std::vector<double> next(kCells, 0.0);
    for (int from = 0; from < kCells; ++from) {
      if (belief_[static_cast<std::size_t>(from)] < 1e-14) continue;
      for (int to = 0; to < kCells; ++to) {
        next[static_cast<std::size_t>(to)] +=
            belief_[static_cast<std::size_t>(from)] * kernel[static_cast<std::size_t>(to - from + kCells)];
      }
    }
    belief_ = next;
  }

  /// The measurement of one frame.
  void update(const AlongX& model, double exponent) {
    for (int i = 0; i < kCells; ++i)
      belief_[static_cast<std::size_t>(i)] *= std::exp(exponent * model.log_likelihood(position(i)));
    const double sum = std::accumulate(belief_.begin(), belief_.end(), 0.0);
    for (double& p : belief_) p /= sum;
  }

  template <typename Function>
  double expect(const Function& f) const {
    double sum = 0.0;
    for (int i = 0; i < kCells; ++i) sum += belief_[static_cast<std::size_t>(i)] * f(position(i));
    return sum;
  }

 private:
  static constexpr int kCells = 2001;
  static constexpr double kCellM = 1e-4;
  static double position(int cell) { return (cell - kCells / 2) * kCellM; }
  std::vector<double> belief_;
};

}  // namespace depth_object_tracker
