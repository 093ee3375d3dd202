// SPDX-License-Identifier: BSD-3-Clause
// A simulated arm holds an object; the tracker may be told where the arm's links are, which is not quite where they
// are.
#pragma once

#include "depth_object_tracker/simulator/simulation_config.h"

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <string>

namespace depth_object_tracker {

struct OccluderTrial {
  std::string object;  ///< file in meshes/
  Scenario scenario = Scenario::kRobot;
  std::uint64_t seed = 1;
  int num_frames = 90;
  /// Error [m], camera axes, of where the links are drawn, on top of that of the reported joints (18 mm at the hand in
  /// the mean); nullopt: they are not known at all.
  std::optional<Eigen::Vector3d> link_error_camera_m;
};

/// Of the position [m], from the first few images on.
struct TrialErrors {
  double median_m, worst_m;
};

TrialErrors runTrial(const OccluderTrial& trial);

}  // namespace depth_object_tracker
