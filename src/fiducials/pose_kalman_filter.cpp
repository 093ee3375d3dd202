// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/fiducials/pose_kalman_filter.h"

#include "depth_object_tracker/model/process_model.h"

#include <Eigen/Dense>

#include <cmath>

namespace depth_object_tracker {
namespace {

Vector6d squaredPairs(double linear, double angular) {
  Vector6d variances;
  variances << Eigen::Vector3d::Constant(linear * linear), Eigen::Vector3d::Constant(angular * angular);
  return variances;
}

}  // namespace

PoseKalmanFilter::PoseKalmanFilter(const PoseKalmanConfig& config, const Eigen::Vector3d& centre_object)
    : config_(config), centre_object_(centre_object) {
  config_.process.sudden_motion_share = 0.0;  // one Gaussian
}

void PoseKalmanFilter::initialise(const Pose& T_camera_object, const Matrix6d& covariance) {
  T_camera_centre_ = T_camera_object * Eigen::Translation3d(centre_object_);
  velocity_.setZero();
  covariance_.setZero();
  covariance_.topLeftCorner<6, 6>() = transportCovariance(covariance, T_camera_object.linear() * centre_object_);
  covariance_.bottomRightCorner<6, 6>() =
      squaredPairs(config_.velocity_stddev_m_per_s, config_.velocity_stddev_rad_per_s).asDiagonal();
}

void PoseKalmanFilter::predict(double dt_s, const std::optional<ControlInput>& control) {
  if (dt_s <= 0.0) return;
  const ProcessStep step(config_.process, dt_s, control, centre_object_, 1.0);
  // ProcessStep is linear in the velocity: its own numbers make up the transition matrix.
  const Vector6d unit = Vector6d::Ones();
  const double decay = step.dampedVelocity(unit)[0];
  const double reach_s =
      difference(step.predict(T_camera_centre_, unit), step.predict(T_camera_centre_, Vector6d::Zero()))[0];
  const bool followed = control && control->isFollowed();
  const Vector6d velocity_variances =
      followed ? squaredPairs(config_.grasped_velocity_stddev_m_per_s, config_.grasped_velocity_stddev_rad_per_s)
               : squaredPairs(config_.velocity_stddev_m_per_s, config_.velocity_stddev_rad_per_s);
  Matrix12d transition = Matrix12d::Identity();
  transition.topRightCorner<6, 6>() = reach_s * Matrix6d::Identity();
  transition.bottomRightCorner<6, 6>() = decay * Matrix6d::Identity();
  T_camera_centre_ = step.predict(T_camera_centre_, velocity_);
  velocity_ = step.dampedVelocity(velocity_);
  covariance_ = (transition * covariance_ * transition.transpose()).eval();
  covariance_.diagonal().head<6>() += step.component(0).variances;
  covariance_.diagonal().tail<6>() += (1.0 - decay * decay) * velocity_variances;  // keeps the velocity's variance
}

bool PoseKalmanFilter::update(const Pose& T_camera_object, const Matrix6d& covariance) {
  const Pose measured = T_camera_object * Eigen::Translation3d(centre_object_);
  const Matrix6d noise = transportCovariance(covariance, T_camera_object.linear() * centre_object_);
  const Vector6d innovation = difference(measured, T_camera_centre_);
  const Matrix6d expected = covariance_.topLeftCorner<6, 6>() + noise;
  const Eigen::LDLT<Matrix6d> solver(expected);
  if (!(innovation.dot(solver.solve(innovation)) <= config_.gate)) return false;
  const Eigen::Matrix<double, 12, 6> gain = solver.solve(covariance_.topRows<6>()).transpose();
  const Eigen::Matrix<double, 12, 1> correction = gain * innovation;
  T_camera_centre_ = perturb(T_camera_centre_, correction.head<6>());
  velocity_ += correction.tail<6>();
  covariance_ -= (gain * expected * gain.transpose()).eval();
  covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();
  return true;
}

Pose PoseKalmanFilter::pose() const {
  return T_camera_centre_ * Eigen::Translation3d(-centre_object_);
}

Matrix6d PoseKalmanFilter::covariance() const {
  return transportCovariance(covariance_.topLeftCorner<6, 6>(), -(T_camera_centre_.linear() * centre_object_));
}

}  // namespace depth_object_tracker
