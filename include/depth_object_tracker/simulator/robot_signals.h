// SPDX-License-Identifier: BSD-3-Clause
// What a simulated robot believes: noisy, biased velocities and wrong forward kinematics.
#pragma once

#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/model/control_input.h"
#include "depth_object_tracker/simulator/random_source.h"

#include <optional>

namespace depth_object_tracker {

struct RobotErrorConfig {
  double twist_noise_m_s = 0.006;  ///< white, per image
  double twist_noise_rad_s = 0.021;
  double twist_bias_m_s = 0.003;  ///< constant
  double twist_bias_rad_s = 0.0105;
  double twist_scale_error = 0.05;    ///< velocities are off by up to this share
  double kinematics_error_m = 0.035;  ///< grows as the arm leaves its first pose
  double kinematics_error_rad = 0.07;
};

/// Not thread-safe; call with increasing time.
class RobotSignals {
 public:
  explicit RobotSignals(std::uint64_t seed, const RobotErrorConfig& config = {});

  /// Commanded mean motion of the object's origin over (previous call, this call]; zero at the first.
  /// @param T_camera_hand true pose of the hand; the robot thinks that the object moves with it.
  ControlInput control(double t_s, const Pose& T_camera_hand, const Pose& T_camera_object);

  /// Where forward kinematics place an object that is at `T_camera_held` if it has not moved in the hand. Exact at the
  /// first call.
  Pose kinematics(const Pose& T_camera_held);

 private:
  struct Previous {
    double t_s;
    Pose T_camera_hand, T_camera_object;
  };
  Vector6d kinematicError(const Pose& T_camera_held) const;

  RobotErrorConfig config_;
  RandomSource random_;
  Vector6d bias_, scale_;
  Eigen::Matrix<double, 6, 3> wave_;  // error per position: sines of this times the position
  std::optional<Previous> previous_;
  std::optional<Vector6d> first_error_;
};

}  // namespace depth_object_tracker
