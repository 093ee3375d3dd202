// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/filter/transition_kernel.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {

TransitionKernel::TransitionKernel(const ProcessStep& step, const Matrix6d& lost_spread)
    : num_components_(step.numComponents()) {
  for (int k = 0; k < num_components_; ++k) {
    Component& component = components_[static_cast<std::size_t>(k)];
    Matrix6d covariance = lost_spread;
    covariance.diagonal() += step.component(k).variances;
    component.weight = step.component(k).weight;
    component.shape = Gaussian6(Vector6d::Zero(), covariance);
    component.information = covariance.ldlt().solve(Matrix6d::Identity());
    component.log_determinant = -component.shape.logDeterminant();
  }
}

Vector6d TransitionKernel::sample(double choice, const Vector6d& standard_normal) const {
  const int k = num_components_ > 1 && choice > component(0).weight ? 1 : 0;
  return component(k).shape.sample(standard_normal);
}

double TransitionKernel::logDensity(const Vector6d& displacement) const {
  const double usual = component(0).shape.logDensity(displacement) + std::log(component(0).weight);
  if (num_components_ == 1) return usual;
  const double sudden = component(1).shape.logDensity(displacement) + std::log(component(1).weight);
  const double larger = std::max(usual, sudden);
  return larger + std::log(std::exp(usual - larger) + std::exp(sudden - larger));
}

}  // namespace depth_object_tracker
