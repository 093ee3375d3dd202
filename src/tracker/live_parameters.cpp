// SPDX-License-Identifier: BSD-3-Clause
// A new live parameter needs a line here, one in cfg/TrackerLive.cfg and one in the test of their effects.
#include "depth_object_tracker/tracker/live_parameters.h"

#include "depth_object_tracker/tracker/tracker_parameters.h"

namespace depth_object_tracker {

const std::vector<std::string>& listLiveParameters() {
  static const std::vector<std::string> names = {
      "position_noise_m_per_sqrt_s",
      "rotation_noise_rad_per_sqrt_s",
      "sudden_motion_share",
      "sudden_motion_scale",
      "velocity_half_life_s",
      "grasped_position_noise_m_per_sqrt_s",
      "grasped_rotation_noise_rad_per_sqrt_s",
      "grasped_position_bias_m_per_s",
      "grasped_rotation_bias_rad_per_s",
      "diffusion_full_above_visible_fraction",
      "hidden_diffusion_scale",
      "max_gap_s",
      "num_particles",
      "likelihood_exponent",
      "downsampling",
      "target_model_pixels",
      "initial_position_stddev_m",
      "initial_rotation_stddev_rad",
      "occluded_below_visible_fraction",
      "lost_below_score",
      "lost_after_s",
      "frame_budget_s",
  };
  return names;
}

TrackerConfig withLiveParameters(const TrackerConfig& config, const TrackerConfig& changed) {
  TrackerConfig result = config;
  for (const std::string& name : listLiveParameters()) {
    setTrackerParameter(result, name, getTrackerParameter(changed, name));
  }
  return result;
}

}  // namespace depth_object_tracker
