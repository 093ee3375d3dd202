// SPDX-License-Identifier: BSD-3-Clause
// Parameters of the pose process models: object moved by a human, object held by a robot.
#pragma once

namespace depth_object_tracker {

struct ProcessConfig {
  double position_noise_m_per_sqrt_s = 0.04;           ///< random motion, standard deviation after 1 s, each axis
  double rotation_noise_rad_per_sqrt_s = 0.25;         ///< random motion, standard deviation after 1 s, each axis
  double sudden_motion_share = 0.02;                   ///< share of frames with motion far beyond; 0 = none (the paper)
  double sudden_motion_scale = 6.0;                    ///< ... and how many times wider it is then
  double velocity_half_life_s = 0.2;                   ///< damped velocity; 0 = none (the paper's random walk)
  double grasped_position_noise_m_per_sqrt_s = 0.008;  ///< the same while a robot holds the object
  double grasped_rotation_noise_rad_per_sqrt_s = 0.05;  ///< the same while a robot holds the object
  double grasped_position_bias_m_per_s = 0.01;          ///< unknown constant error of the given linear velocity
  double grasped_rotation_bias_rad_per_s = 0.05;        ///< unknown constant error of the given angular velocity
  double grasped_velocity_half_life_s = 0.1;            ///< of the motion in the hand (slip); 0 = none (the paper)
  double diffusion_full_above_visible_fraction = 0.25;  ///< less seen: motion is held back; 0 = never (the paper)
  double hidden_diffusion_scale = 0.25;                 ///< share of the random motion left when nothing is seen
  double max_gap_s = 1.0;  ///< longer gaps between images: noise clamped there, velocity zero
};

}  // namespace depth_object_tracker
