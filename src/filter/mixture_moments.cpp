// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/filter/mixture_moments.h"

#include <cmath>

namespace depth_object_tracker {

void MixtureMoments::add(double log_weight, const Vector6d& mean, const Matrix6d& covariance) {
  if (empty()) {
    log_scale_ = log_weight;
  } else if (log_weight > log_scale_) {
    const double shrink = std::exp(log_scale_ - log_weight);
    weight_ *= shrink;
    sum_ *= shrink;
    second_ *= shrink;
    log_scale_ = log_weight;
  }
  const double weight = std::exp(log_weight - log_scale_);
  weight_ += weight;
  sum_ += weight * mean;
  second_ += weight * (covariance + mean * mean.transpose());
}

Matrix6d MixtureMoments::covariance() const {
  const Vector6d middle = mean();
  return second_ / weight_ - middle * middle.transpose();
}

}  // namespace depth_object_tracker
