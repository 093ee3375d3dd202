// SPDX-License-Identifier: BSD-3-Clause
// Density of a particle's next pose about its predicted one.
#pragma once

#include "depth_object_tracker/filter/gaussian6.h"
#include "depth_object_tracker/model/process_model.h"

#include <array>

namespace depth_object_tracker {

/// The process step's Gaussians, each widened by the spread that resampling took from the cloud. Drawing n poses anew
/// out of n_eff loses 1/n_eff of the covariance in every direction; where images say nothing, frame after frame, the
/// cloud would shrink to n_eff steps of the process however wide the posterior is, and wander within it.
class TransitionKernel {
 public:
  static constexpr int kMaxComponents = ProcessStep::kMaxComponents;
  struct Component {
    double weight = 1.0;
    Gaussian6 shape;                              ///< about the predicted pose
    Matrix6d information = Matrix6d::Identity();  ///< inverse of the shape's covariance
    double log_determinant = 0.0;                 ///< of the information
  };

  /// @param lost_spread [m, rad]^2, positive semidefinite.
  explicit TransitionKernel(const ProcessStep& step, const Matrix6d& lost_spread = Matrix6d::Zero());

  int numComponents() const { return num_components_; }
  const Component& component(int k) const { return components_[static_cast<std::size_t>(k)]; }
  const Component& widestComponent() const { return component(num_components_ - 1); }

  /// @param choice uniform in (0, 1) picks the component.
  Vector6d sample(double choice, const Vector6d& standard_normal) const;
  /// Log density [nat] of a displacement from the predicted pose.
  double logDensity(const Vector6d& displacement) const;

 private:
  int num_components_ = 1;
  std::array<Component, kMaxComponents> components_;
};

}  // namespace depth_object_tracker
