// SPDX-License-Identifier: BSD-3-Clause
// Parameters of the motion of an object in the hand that holds it.
#pragma once

namespace depth_object_tracker {

struct SlipConfig {
  double slip_position_stddev_m_per_s = 0.02;        ///< how fast objects slip, each axis
  double slip_rotation_stddev_rad_per_s = 0.2;       ///< how fast objects turn in the hand, each axis
  double slip_time_constant_s = 0.5;                 ///< how long a slip goes on at about the same velocity
  double kinematics_position_error_m_per_s = 0.006;  ///< the robot's own error: slow, what is below is no slip
  double kinematics_rotation_error_rad_per_s = 0.025;
  double kinematics_relative_error = 0.04;  ///< share of the hand's velocity that may be wrong on top of that
  double pushed_arm_error_m_per_s = 0.0;    ///< how fast a hand yields to a push that its joints do not see, each axis
  double slip_threshold = 8.0;  ///< squared Mahalanobis length of the motion in the hand, beyond what a push explains
  double slip_noise_scale_max = 4.0;  ///< the noise in the hand is widened in a slip, at most so much; 1 = never
};

}  // namespace depth_object_tracker
