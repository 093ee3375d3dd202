// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/filter/gaussian6.h"

#include <cmath>

namespace depth_object_tracker {

double logRotationVolume(const Eigen::Vector3d& rotation_vector) {
  // det J = 2 (1 - cos a) / a^2 = (sin(a/2) / (a/2))^2
  const double half = 0.5 * rotation_vector.norm();
  if (half < 1e-4) return -half * half / 3.0;
  return 2.0 * std::log(std::max(std::abs(std::sin(half)) / half, 1e-12));
}

Gaussian6::Gaussian6(const Vector6d& mean, const Matrix6d& covariance) : mean_(mean) {
  Eigen::LLT<Matrix6d> decomposition(covariance);
  for (double ridge = 1e-12; decomposition.info() != Eigen::Success && ridge < 1.0; ridge *= 10.0) {
    decomposition.compute(covariance + ridge * Matrix6d::Identity());
  }
  factor_ = decomposition.matrixL();
  log_normaliser_ = -3.0 * std::log(2.0 * M_PI) - factor_.diagonal().array().log().sum();
}

double Gaussian6::logDensity(const Vector6d& x) const {
  const Vector6d whitened = factor_.triangularView<Eigen::Lower>().solve(x - mean_);
  return log_normaliser_ - 0.5 * whitened.squaredNorm();
}

}  // namespace depth_object_tracker
