// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/model/slip_estimator.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

constexpr double kReleaseShare = 0.5;  // of the threshold: a slip that has begun ends below this

/// Both halves of a 6-vector from camera to object axes.
Vector6d rotated(const Eigen::Matrix3d& R, const Vector6d& vector) {
  Vector6d result;
  result << R * vector.head<3>(), R * vector.tail<3>();
  return result;
}

}  // namespace

void SlipEstimator::reset() {
  axes_ = {};
  started_ = false;
  contradiction_ = 0.0;
  slipping_ = false;
}

void SlipEstimator::advance(Axis& axis, double dt_s, double stationary_stddev) const {
  // Exact for the mean; the noise is put into the velocity, which is what matters over a few frames.
  const double tau_s = config_.slip_time_constant_s;
  const double decay = std::exp(-dt_s / tau_s);
  Eigen::Matrix2d transition;
  transition << 1.0, tau_s * (1.0 - decay), 0.0, decay;
  const double velocity_variance = stationary_stddev * stationary_stddev * (1.0 - decay * decay);
  axis.position += transition(0, 1) * axis.velocity;
  axis.velocity *= decay;
  axis.covariance = transition * axis.covariance * transition.transpose();
  // A velocity that changes during the step moves the object by half of it.
  const Eigen::Vector2d gain(0.5 * dt_s, 1.0);
  axis.covariance += velocity_variance * gain * gain.transpose();
}

void SlipEstimator::correct(Axis& axis, double variance) {
  const double innovation = axis.measured - axis.position;
  const Eigen::Vector2d gain = axis.covariance.col(0) / (axis.covariance(0, 0) + variance);
  axis.position += gain[0] * innovation;
  axis.velocity += gain[1] * innovation;
  axis.covariance -= gain * axis.covariance.row(0).eval();
}

SlipEstimate SlipEstimator::update(const HandStep& step) {
  const Eigen::Matrix3d R_object_camera = step.R_camera_object.transpose();
  const Vector6d residual = rotated(R_object_camera, step.residual);
  const Eigen::Matrix3d shares = R_object_camera.cwiseAbs2();
  const double linear_error = config_.kinematics_position_error_m_per_s +
                              config_.kinematics_relative_error * step.hand_velocity.head<3>().norm();
  const double angular_error = config_.kinematics_rotation_error_rad_per_s +
                               config_.kinematics_relative_error * step.hand_velocity.tail<3>().norm();
  Vector6d twist, variances;
  double statistic = 0.0;
  contradiction_ = 0.0;
  for (int k = 0; k < 6; ++k) {
    Axis& axis = axes_[static_cast<std::size_t>(k)];
    const bool is_linear = k < 3;
    const auto pose_variances = is_linear ? step.pose_variances.head<3>() : step.pose_variances.tail<3>();
    const double variance = shares.row(k % 3) * pose_variances;
    const double stationary = is_linear ? config_.slip_position_stddev_m_per_s : config_.slip_rotation_stddev_rad_per_s;
    if (!started_) axis.covariance << variance, 0.0, 0.0, stationary * stationary;
    axis.measured += residual[k];
    advance(axis, step.dt_s, stationary);
    correct(axis, variance);
    const double error = is_linear ? linear_error : angular_error;
    twist[k] = axis.velocity;
    variances[k] = axis.covariance(1, 1) + error * error;
    contradiction_ += twist[k] * twist[k] / variances[k];
    const double pushed = error + (is_linear ? config_.pushed_arm_error_m_per_s : 0.0);
    statistic += twist[k] * twist[k] / (axis.covariance(1, 1) + pushed * pushed);
  }
  started_ = true;
  slipping_ = statistic > config_.slip_threshold * (slipping_ ? kReleaseShare : 1.0);

  SlipEstimate estimate;
  estimate.relative_twist = rotated(step.R_camera_object, twist);
  estimate.covariance.setZero();
  const Eigen::Matrix3d& R = step.R_camera_object;
  estimate.covariance.topLeftCorner<3, 3>() = R * variances.head<3>().asDiagonal() * R.transpose();
  estimate.covariance.bottomRightCorner<3, 3>() = R * variances.tail<3>().asDiagonal() * R.transpose();
  estimate.statistic = statistic;
  estimate.slipping = slipping_;
  return estimate;
}

double SlipEstimator::noiseScale() const {
  constexpr double kUsual = 2.0;  // at most times it is below
  return std::clamp(std::sqrt(contradiction_ / kUsual), 1.0, config_.slip_noise_scale_max);
}

}  // namespace depth_object_tracker
