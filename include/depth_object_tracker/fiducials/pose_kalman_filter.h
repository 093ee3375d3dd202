// SPDX-License-Identifier: BSD-3-Clause
// Extended Kalman filter over pose and velocity, with the tracker's own process models.
#pragma once

#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/model/control_input.h"
#include "depth_object_tracker/model/process_config.h"

#include <optional>

namespace depth_object_tracker {

struct PoseKalmanConfig {
  ProcessConfig process;
  double velocity_stddev_m_per_s = 0.4;            ///< of a hand-held object, each axis
  double velocity_stddev_rad_per_s = 2.0;          ///< of a hand-held object, each axis
  double grasped_velocity_stddev_m_per_s = 0.03;   ///< in a robot's hand, relative to it
  double grasped_velocity_stddev_rad_per_s = 0.3;  ///< in a robot's hand, relative to it
  double gate = 60.0;  ///< measurements farther off (squared Mahalanobis length) are refused
};

/// The state's error is [pose (6); velocity (6)] of the object's centre, camera axes, as in ProcessStep.
class PoseKalmanFilter {
 public:
  /// @param centre_object point that the motion is modelled for, object frame.
  PoseKalmanFilter(const PoseKalmanConfig& config, const Eigen::Vector3d& centre_object);

  /// Starts at rest. @param covariance of the mesh origin's pose.
  void initialise(const Pose& T_camera_object, const Matrix6d& covariance);

  /// Moves on by dt_s >= 0: damped velocity, or as the robot says.
  void predict(double dt_s, const std::optional<ControlInput>& control);

  /// @param covariance of the mesh origin's measured pose. @return false when the gate refused it.
  bool update(const Pose& T_camera_object, const Matrix6d& covariance);

  Pose pose() const;
  Matrix6d covariance() const;  ///< of the mesh origin's pose
  /// [m/s, rad/s] of the centre; relative to the hand while control is followed.
  const Vector6d& velocity() const { return velocity_; }

 private:
  using Matrix12d = Eigen::Matrix<double, 12, 12>;

  PoseKalmanConfig config_;
  Eigen::Vector3d centre_object_;
  Pose T_camera_centre_ = Pose::Identity();
  Vector6d velocity_ = Vector6d::Zero();
  Matrix12d covariance_ = Matrix12d::Identity();
};

}  // namespace depth_object_tracker
