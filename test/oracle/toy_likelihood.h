// SPDX-License-Identifier: BSD-3-Clause
// Likelihoods of poses that are simple enough to know the posterior without a filter.
#pragma once

#include "depth_object_tracker/filter/pose_likelihood.h"
#include "depth_object_tracker/model/process_model.h"

#include <Eigen/LU>

#include <functional>
#include <optional>
#include <utility>

namespace depth_object_tracker {

/// A likelihood made of functions; poses are near the identity and stand for 6-vectors.
class ToyLikelihood : public PoseLikelihood {
 public:
  using Value = std::function<double(const Vector6d&)>;
  using LocalModel = std::function<Linearisation(const Vector6d&)>;

  /// @param local_model what the mode search is told; it may be wrong, the posterior must not depend on it.
  ToyLikelihood(Value log_likelihood, LocalModel local_model)
      : log_likelihood_(std::move(log_likelihood)), local_model_(std::move(local_model)) {}

  static Vector6d vectorOf(const Pose& pose) { return difference(pose, Pose::Identity()); }

  void prepare(const std::vector<Pose>&) override {}
  double logLikelihood(const Pose& pose, int) override { return log_likelihood_(vectorOf(pose)); }
  Linearisation linearise(const Pose& pose, double, int) override { return local_model_(vectorOf(pose)); }
  void update(const std::vector<Pose>& poses, std::vector<double>& log_likelihoods) override {
    log_likelihoods.clear();
    for (const Pose& pose : poses) log_likelihoods.push_back(log_likelihood_(vectorOf(pose)));
  }
  void resample(const std::vector<int>&) override {}

 private:
  Value log_likelihood_;
  LocalModel local_model_;
};

/// log L = -(x - measured).information.(x - measured) / 2, with its exact local model.
inline ToyLikelihood gaussianToy(const Vector6d& measured, const Matrix6d& information) {
  return {[=](const Vector6d& x) { return -0.5 * (x - measured).dot(information * (x - measured)); },
          [=](const Vector6d& x) {
            return Linearisation{information * (measured - x), information};
          }};
}

/// Random walk as in the paper: no velocity, no sudden motion, never held back.
inline ProcessConfig randomWalk(double position_m_per_sqrt_s, double rotation_rad_per_sqrt_s) {
  ProcessConfig config;
  config.position_noise_m_per_sqrt_s = position_m_per_sqrt_s;
  config.rotation_noise_rad_per_sqrt_s = rotation_rad_per_sqrt_s;
  config.velocity_half_life_s = 0.0;
  config.sudden_motion_share = 0.0;
  config.diffusion_full_above_visible_fraction = 0.0;
  return config;
}

inline ProcessStep stepOf(const ProcessConfig& config, double dt_s) {
  return {config, dt_s, std::nullopt, Eigen::Vector3d::Zero(), 1.0};
}

}  // namespace depth_object_tracker
