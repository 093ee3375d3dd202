// SPDX-License-Identifier: BSD-3-Clause
// A simulated arm holds an object; the tracker may be told where the arm's links are, which is not quite where they
// are.
#pragma once

#include "depth_object_tracker/simulator/robot_arm.h"
#include "depth_object_tracker/simulator/scene_simulator.h"
#include "depth_object_tracker/simulator/simulation_config.h"
#include "depth_object_tracker/tracker/object_model.h"

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace depth_object_tracker {

/// Of the position [m], from the first few images on.
struct TrialErrors {
  double median_m, worst_m;
};

/// Images and joints of one scene, recorded once and tracked in several ways.
class OccluderTrial {
 public:
  /// @param object file in meshes/. @param seed of the scene.
  OccluderTrial(const std::string& object, Scenario scenario, std::uint64_t seed, int num_frames);

  /// @param link_error_camera_m error [m], camera axes, of where the links are drawn, on top of that of the reported
  /// joints (18 mm at the hand in the mean); nullopt: they are not known at all. @param seed of the tracker.
  TrialErrors track(const std::optional<Eigen::Vector3d>& link_error_camera_m, std::uint64_t seed = 1) const;

  const std::string& name() const { return name_; }

 private:
  std::string name_;  // object and seed
  SimulationConfig config_;
  ObjectModel model_;
  Pose initial_ = Pose::Identity(), T_camera_root_ = Pose::Identity();
  std::vector<SimulatedFrame> frames_;
  std::vector<SimulatedJoints> joints_;
};

/// Errors with the links, relative to those without: geometric means.
struct ErrorRatios {
  void add(const TrialErrors& with, const TrialErrors& without);
  double median() const;
  double worst() const;

  double log_median = 0.0, log_worst = 0.0;
  int count = 0;
};

}  // namespace depth_object_tracker
