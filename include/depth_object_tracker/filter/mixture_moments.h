// SPDX-License-Identifier: BSD-3-Clause
// Mean and covariance of a mixture of Gaussians over pose perturbations whose weights are only known up to a factor.
#pragma once

#include "depth_object_tracker/geometry/pose.h"

namespace depth_object_tracker {

/// Streaming: no component is stored. All in one tangent chart.
class MixtureMoments {
 public:
  /// @param log_weight [nat], up to a constant that is the same for all; finite.
  void add(double log_weight, const Vector6d& mean, const Matrix6d& covariance);

  bool empty() const { return !(weight_ > 0.0); }
  /// Not empty.
  Vector6d mean() const { return sum_ / weight_; }
  Matrix6d covariance() const;

 private:
  double log_scale_ = 0.0;  // sums are to be multiplied by exp of this
  double weight_ = 0.0;
  Vector6d sum_ = Vector6d::Zero();
  Matrix6d second_ = Matrix6d::Zero();
};

}  // namespace depth_object_tracker
