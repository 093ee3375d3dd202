// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/model/process_model.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

const double kLogTwoPi = std::log(2.0 * M_PI);

// Keeps densities finite for two images a microsecond apart.
constexpr double kMinPositionStddevM = 1e-5;
constexpr double kMinRotationStddevRad = 1e-4;

}  // namespace

double ProcessComponent::logDensity(const Vector6d& displacement) const {
  return -0.5 * (displacement.cwiseAbs2().cwiseQuotient(variances).sum() + variances.array().log().sum()) -
         3.0 * kLogTwoPi;
}

ProcessStep::ProcessStep(const ProcessConfig& config, double dt_s, const std::optional<ControlInput>& control,
                         const Eigen::Vector3d& centre_object, double diffusion_scale, double slip_scale)
    : dt_s_(std::clamp(dt_s, 0.0, config.max_gap_s)),
      control_dt_s_(std::max(dt_s, 0.0)),
      centre_object_(centre_object) {
  if (control && control->isFollowed()) control_ = control;
  const double half_life_s = control_ ? config.grasped_velocity_half_life_s : config.velocity_half_life_s;
  if (dt_s <= config.max_gap_s && half_life_s > 0.0) {
    const double rate = M_LN2 / half_life_s;
    velocity_decay_ = std::exp(-rate * dt_s_);
    velocity_displacement_s_ = -std::expm1(-rate * dt_s_) / rate;
  }
  const auto square = [](double x) { return x * x; };
  Vector6d variances;
  if (control_) {
    variances.head<3>().setConstant(square(config.grasped_position_noise_m_per_sqrt_s * slip_scale) * dt_s_ +
                                    square(config.grasped_position_bias_m_per_s * slip_scale * dt_s_));
    variances.tail<3>().setConstant(square(config.grasped_rotation_noise_rad_per_sqrt_s * slip_scale) * dt_s_ +
                                    square(config.grasped_rotation_bias_rad_per_s * slip_scale * dt_s_));
  } else {
    variances.head<3>().setConstant(square(config.position_noise_m_per_sqrt_s * diffusion_scale) * dt_s_);
    variances.tail<3>().setConstant(square(config.rotation_noise_rad_per_sqrt_s * diffusion_scale) * dt_s_);
  }
  setNoise(config, variances);
}

ProcessStep::ProcessStep(const ProcessConfig& config, const Vector6d& variances) {
  setNoise(config, variances);
}

void ProcessStep::setNoise(const ProcessConfig& config, Vector6d variances) {
  variances.head<3>() = variances.head<3>().cwiseMax(kMinPositionStddevM * kMinPositionStddevM);
  variances.tail<3>() = variances.tail<3>().cwiseMax(kMinRotationStddevRad * kMinRotationStddevRad);
  components_[0].variances = variances;
  if (config.sudden_motion_share <= 0.0) return;
  num_components_ = 2;
  components_[0].weight = 1.0 - config.sudden_motion_share;
  components_[1].weight = config.sudden_motion_share;
  components_[1].variances = variances * (config.sudden_motion_scale * config.sudden_motion_scale);
}

void ProcessStep::excludeSuddenMotion() {
  num_components_ = 1;
  components_[0].weight = 1.0;
}

Pose ProcessStep::predict(const Pose& T_camera_centre, const Vector6d& velocity) const {
  return perturb(T_camera_centre, controlDisplacement(T_camera_centre) + velocity * velocity_displacement_s_);
}

Vector6d ProcessStep::controlDisplacement(const Pose& T_camera_centre) const {
  if (!control_) return Vector6d::Zero();
  // The control speaks of the mesh origin; the filter's point moves along with omega x (R c), here for a whole turn.
  const Eigen::Vector3d lever = T_camera_centre.linear() * centre_object_;
  const Eigen::Vector3d rotation = control_->angular_rad_s * control_dt_s_;
  Vector6d displacement;
  displacement << control_->linear_m_s * control_dt_s_ + expSo3(rotation) * lever - lever, rotation;
  return displacement;
}

Vector6d ProcessStep::dampedVelocity(const Vector6d& velocity) const {
  return velocity * velocity_decay_;
}

Vector6d ProcessStep::meanVariances() const {
  Vector6d variances = Vector6d::Zero();
  for (int k = 0; k < num_components_; ++k) variances += component(k).weight * component(k).variances;
  return variances;
}

double ProcessStep::logDensity(const Vector6d& displacement) const {
  const double usual = components_[0].logDensity(displacement) + std::log(components_[0].weight);
  if (num_components_ == 1) return usual;
  const double sudden = components_[1].logDensity(displacement) + std::log(components_[1].weight);
  const double larger = std::max(usual, sudden);
  return larger + std::log(std::exp(usual - larger) + std::exp(sudden - larger));
}

}  // namespace depth_object_tracker
