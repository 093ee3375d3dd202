// SPDX-License-Identifier: BSD-3-Clause
// Gaussian over pose perturbations in one tangent chart.
#pragma once

#include "depth_object_tracker/geometry/pose.h"

#include <Eigen/Cholesky>

namespace depth_object_tracker {

/// log |det| of the left Jacobian of SO(3) at a rotation vector: turns densities over rotation vectors into densities
/// over rotations, which do not depend on the chart. [nat], <= 0.
double logRotationVolume(const Eigen::Vector3d& rotation_vector);

class Gaussian6 {
 public:
  Gaussian6() = default;
  /// @param covariance symmetric positive definite (a tiny ridge is added when rounding spoils that).
  Gaussian6(const Vector6d& mean, const Matrix6d& covariance);

  const Vector6d& mean() const { return mean_; }
  Matrix6d covariance() const { return factor_ * factor_.transpose(); }
  Vector6d sample(const Vector6d& standard_normal) const { return mean_ + factor_ * standard_normal; }
  /// [nat]
  double logDensity(const Vector6d& x) const;

 private:
  Vector6d mean_ = Vector6d::Zero();
  Matrix6d factor_ = Matrix6d::Identity();  // lower Cholesky factor of the covariance
  double log_normaliser_ = 0.0;
};

}  // namespace depth_object_tracker
