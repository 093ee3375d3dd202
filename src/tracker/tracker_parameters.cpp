// SPDX-License-Identifier: BSD-3-Clause
// The table of parameters: one line per field of TrackerConfig. A new field needs a line here and one in
// config/tracker.yaml.
#include "depth_object_tracker/tracker/tracker_parameters.h"

#include "depth_object_tracker/tracker/nearest_name.h"
#include "parameter_binding.h"

#include <cstdint>
#include <limits>
#include <stdexcept>

namespace depth_object_tracker {
namespace {

using Bindings = std::vector<ParameterBinding>;

/// Name and accessor of a field; the key of the parameter is the field's name.
#define FIELD(group, member) \
#member, +[](TrackerConfig & config) -> decltype(config.group.member)& { return config.group.member; }
/// The same, with a key that differs from the field's name.
#define FIELD_AS(key, group, member) \
  key, +[](TrackerConfig& config) -> decltype(config.group.member)& { return config.group.member; }

// clang-format off
Bindings measurementBindings() {
  return {
    bindChoice<OccluderModel>(FIELD(pixel, occluder_model), {{"consistent", OccluderModel::kConsistent}, {"paper", OccluderModel::kPaper}},
               "density of occluders: consistent = independent of the object; paper = renormalised to lie in front of it"),
    bindNumber(FIELD(pixel, object_noise_stddev_m), 1e-5, 0.1, "how far the mesh is from the real surface"),
    bindNumber(FIELD(pixel, depth_noise_per_m), 0.0, 0.1, "depth noise of the camera: standard deviation = this * depth^2"),
    bindNumber(FIELD(pixel, edge_stddev_px), 0.0, 10.0, "how well the camera sees where an outline is, full-resolution pixels; 0 = to the pixel (the paper)"),
    bindNumber(FIELD(pixel, tail_weight), 1e-6, 0.5, "share of readings that may be anything between 0 and max_depth_m"),
    bindNumber(FIELD(pixel, max_depth_m), 0.1, 100.0, "readings beyond are treated as missing"),
    bindNumber(FIELD(pixel, known_occluder_p_occluded), 0.0, 0.99, "least probability of occlusion behind a known occluder (a link of the robot); 0 = they are ignored"),
    bindNumber(FIELD(pixel, known_occluder_margin_m), 0.0, 1.0, "how well the place of a known occluder is known: what is less far behind it is not behind it"),
    bindNumber(FIELD(pixel, min_p_occluded_in_front), 0.0, 0.99, "least probability of occlusion for readings far in front of the object; 0 = unused (the paper)"),
    bindNumber(FIELD(pixel, no_reading_ratio), 0.01, 1.0, "pixels without a reading: how much rarer they are on the visible object than elsewhere; 1 = they say nothing (the paper)"),
    bindNumber(FIELD(pixel, occluder_half_life_m), 0.01, 100.0, "distance over which the density of occluders halves"),
    bindNumber(FIELD(occlusion, p_visible_given_visible), 0.001, 0.999, "probability that a visible pixel is visible one second later; not less than p_visible_given_occluded: as much = no memory, see beam.yaml"),
    bindNumber(FIELD(occlusion, p_visible_given_occluded), 0.001, 0.999, "probability that an occluded pixel is visible one second later"),
    bindNumber(FIELD(occlusion, initial_p_occluded), 0.0, 1.0, "probability that a pixel is occluded before anything is known"),
  };
}

Bindings processBindings() {
  return {
    bindNumber(FIELD(process, position_noise_m_per_sqrt_s), 1e-5, 10.0, "random motion of a free object: standard deviation after 1 s, each axis"),
    bindNumber(FIELD(process, rotation_noise_rad_per_sqrt_s), 1e-5, 30.0, "random rotation of a free object: standard deviation after 1 s, each axis"),
    bindNumber(FIELD(process, sudden_motion_share), 0.0, 0.5, "share of frames with motion far beyond; 0 = none (the paper)"),
    bindNumber(FIELD(process, sudden_motion_scale), 1.0, 100.0, "how many times wider the motion is then"),
    bindNumber(FIELD(process, velocity_half_life_s), 0.0, 10.0, "time over which a remembered velocity halves; 0 = no velocity (the paper)"),
    bindNumber(FIELD(process, grasped_position_noise_m_per_sqrt_s), 1e-5, 10.0, "random motion of an object that a robot holds"),
    bindNumber(FIELD(process, grasped_rotation_noise_rad_per_sqrt_s), 1e-5, 30.0, "random rotation of an object that a robot holds"),
    bindNumber(FIELD(process, grasped_position_bias_m_per_s), 0.0, 1.0, "constant error of the robot's linear velocity, standard deviation"),
    bindNumber(FIELD(process, grasped_rotation_bias_rad_per_s), 0.0, 10.0, "constant error of the robot's angular velocity, standard deviation"),
    bindNumber(FIELD(process, grasped_velocity_half_life_s), 0.0, 10.0, "time over which a motion in the robot's hand (slip) halves; 0 = no such motion (the paper)"),
    bindNumber(FIELD(process, diffusion_full_above_visible_fraction), 0.0, 1.0, "when less of the object is seen, random motion is held back; 0 = never (the paper)"),
    bindNumber(FIELD(process, hidden_diffusion_scale), 0.001, 1.0, "share of the random motion that is left when nothing is seen"),
    bindNumber(FIELD(process, max_gap_s), 0.01, 60.0, "longer gaps between images count as this long, with zero velocity"),
  };
}

Bindings slipBindings() {
  return {
    bindNumber(FIELD(slip, slip_position_stddev_m_per_s), 1e-4, 10.0, "how fast objects slip in a robot's hand, standard deviation, each axis"),
    bindNumber(FIELD(slip, slip_rotation_stddev_rad_per_s), 1e-3, 100.0, "how fast objects turn in a robot's hand, standard deviation, each axis"),
    bindNumber(FIELD(slip, slip_time_constant_s), 0.01, 10.0, "how long a slip goes on at about the same velocity"),
    bindNumber(FIELD(slip, kinematics_position_error_m_per_s), 0.0, 1.0, "error of the robot's linear velocity that is no slip, standard deviation"),
    bindNumber(FIELD(slip, kinematics_rotation_error_rad_per_s), 0.0, 10.0, "error of the robot's angular velocity that is no slip, standard deviation"),
    bindNumber(FIELD(slip, kinematics_relative_error), 0.0, 1.0, "share of the hand's velocity that may be wrong on top of that"),
    bindNumber(FIELD(slip, pushed_arm_error_m_per_s), 0.0, 10.0, "how fast the hand yields to somebody who pushes the arm, which its joints do not see: so slow a motion is no slip; 0 = nobody does"),
    bindNumber(FIELD(slip, slip_threshold), 0.0, 1e6, "an object slips when its motion in the hand is longer than this (squared Mahalanobis length)"),
    bindNumber(FIELD(slip, slip_noise_scale_max), 1.0, 100.0, "the noise in the hand is widened in a slip, at most so much; 1 = never (the paper)"),
  };
}

Bindings filterBindings() {
  return {
    bindChoice<Proposal>(FIELD(filter, proposal), {{"informed", Proposal::kInformed}, {"process", Proposal::kProcess}},
               "where particles are drawn: informed = process model times a fit to the image; process = process model alone (the paper)"),
    bindNumber(FIELD(filter, num_particles), 1, 100000, "number of particles"),
    bindNumber(FIELD(filter, prior_share), 0.0, 1.0, "informed: share of particles that still draw from the process model alone"),
    bindNumber(FIELD(filter, likelihood_exponent), 0.0, 1.0, "power of each frame's likelihood (pixels are not independent); 1 = the paper, 0 = chosen from the sampling factor"),
    bindNumber(FIELD(filter, resampling_threshold), 0.0, 1.0, "resample when the effective share of particles is below; 1 = every frame (the paper)"),
    bindSwitch(FIELD(filter, smooth_estimate), "the published pose is averaged over the images in which the object rests or moves evenly; false = every image by itself (the paper)"),
    bindNumber(FIELD(filter, seed), 0, std::numeric_limits<int>::max(), "seed of the random numbers: the same seed gives the same result"),
    bindNumber(FIELD(filter, num_threads), 1, 256, "number of threads; the result does not depend on it"),
  };
}

Bindings operationBindings() {
  return {
    bindNumberOrWord(FIELD(resolution, downsampling), 0, 64, "auto", 0, "every n-th pixel of every n-th row is used; 0 or auto = chosen from the object's size in the image"),
    bindNumber(FIELD(resolution, target_model_pixels), 50, 1000000, "automatic downsampling: number of object pixels aimed at"),
    bindNumber(FIELD_AS("initial_position_stddev_m", initialisation, position_stddev_m), 1e-5, 10.0, "spread around an initial pose that comes without covariance, each axis"),
    bindNumber(FIELD_AS("initial_rotation_stddev_rad", initialisation, rotation_stddev_rad), 1e-5, 10.0, "spread around an initial pose that comes without covariance, each axis"),
    bindNumber(FIELD(status, occluded_below_visible_fraction), 0.0, 1.0, "OCCLUDED when less of the object than this share is believed visible"),
    bindNumber(FIELD(status, lost_below_score), 0.0, 1.0, "LOST when the score stays below this for lost_after_s"),
    bindNumber(FIELD(status, lost_after_s), 0.0, 60.0, "time for which the score must stay below lost_below_score"),
    bindNumber(FIELD(budget, frame_budget_s), 0.0, 10.0, "the nodelet takes fewer particles and pixels when frames take longer than this; 0 = never"),
  };
}
// clang-format on

#undef FIELD
#undef FIELD_AS

const Bindings& bindings() {
  static const Bindings all = [] {
    Bindings list;
    for (Bindings (*group)() :
         {measurementBindings, processBindings, slipBindings, filterBindings, operationBindings}) {
      for (ParameterBinding& binding : group()) list.push_back(std::move(binding));
    }
    return list;
  }();
  return all;
}

const ParameterBinding& findBinding(const std::string& name) {
  std::vector<std::string> names;
  for (const ParameterBinding& binding : bindings()) {
    if (binding.info.name == name) return binding;
    names.push_back(binding.info.name);
  }
  throw std::invalid_argument("parameter `" + name + "` is unknown; the nearest known one is `" +
                              nearestName(name, names) + "`");
}

}  // namespace

std::vector<ParameterInfo> listTrackerParameters() {
  std::vector<ParameterInfo> list;
  for (const ParameterBinding& binding : bindings()) list.push_back(binding.info);
  return list;
}

ParameterValue getTrackerParameter(const TrackerConfig& config, const std::string& name) {
  return findBinding(name).get(config);
}

void setTrackerParameter(TrackerConfig& config, const std::string& name, const ParameterValue& value) {
  findBinding(name).set(config, value);
}

void validateTrackerConfig(const TrackerConfig& config) {
  TrackerConfig scratch;
  for (const ParameterBinding& binding : bindings()) binding.set(scratch, binding.get(config));
  // A chain that alternates has no power of dt: it could not be split into shorter steps.
  if (config.occlusion.p_visible_given_visible < config.occlusion.p_visible_given_occluded) {
    throwOutOfRange("p_visible_given_visible", config.occlusion.p_visible_given_visible,
                    "not less than p_visible_given_occluded (" +
                        formatParameterValue(config.occlusion.p_visible_given_occluded) + ")");
  }
}

}  // namespace depth_object_tracker
