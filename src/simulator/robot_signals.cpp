// SPDX-License-Identifier: BSD-3-Clause
// What a simulated robot believes.
#include "depth_object_tracker/simulator/robot_signals.h"

namespace depth_object_tracker {
namespace {

constexpr std::uint64_t kStream = 107;
constexpr double kWavePerM = 7.0;  // the error changes over decimetres, as sagging links and wrong joint offsets do

Vector6d stack(const Eigen::Vector3d& linear, const Eigen::Vector3d& angular) {
  Vector6d vector;
  vector << linear, angular;
  return vector;
}

}  // namespace

RobotSignals::RobotSignals(std::uint64_t seed, const RobotErrorConfig& config)
    : config_(config), random_(seed, kStream) {
  bias_ = stack(config.twist_bias_m_s * random_.unitVector(), config.twist_bias_rad_s * random_.unitVector());
  for (int k = 0; k < 6; ++k) {
    scale_[k] = 1.0 + random_.uniform(-config.twist_scale_error, config.twist_scale_error);
    wave_.row(k) = kWavePerM * random_.unitVector().transpose();
  }
}

ControlInput RobotSignals::control(double t_s, const Pose& T_camera_hand, const Pose& T_camera_object) {
  ControlInput control;
  control.grasped = true;
  if (previous_ && t_s > previous_->t_s) {
    const Pose T_expected = T_camera_hand * previous_->T_camera_hand.inverse() * previous_->T_camera_object;
    Vector6d twist = difference(T_expected, previous_->T_camera_object) / (t_s - previous_->t_s);
    twist = scale_.cwiseProduct(twist) + bias_;
    twist +=
        stack(config_.twist_noise_m_s * random_.normalVector(), config_.twist_noise_rad_s * random_.normalVector());
    control.linear_m_s = twist.head<3>();
    control.angular_rad_s = twist.tail<3>();
  }
  previous_ = Previous{t_s, T_camera_hand, T_camera_object};
  return control;
}

Vector6d RobotSignals::kinematicError(const Pose& T_camera_held) const {
  Vector6d error = (wave_ * T_camera_held.translation()).array().sin().matrix();
  error.head<3>() *= config_.kinematics_error_m;
  error.tail<3>() *= config_.kinematics_error_rad;
  return error;
}

Pose RobotSignals::kinematics(const Pose& T_camera_held) {
  const Vector6d error = kinematicError(T_camera_held);
  if (!first_error_) first_error_ = error;
  return perturb(T_camera_held, error - *first_error_);
}

}  // namespace depth_object_tracker
