// SPDX-License-Identifier: BSD-3-Clause
// The ROS parameters of the simulator nodelet.
#pragma once

#include "depth_object_tracker/simulator/simulation_config.h"

#include <ros/node_handle.h>

#include <string>
#include <vector>

namespace depth_object_tracker {

struct SimulatorOptions {
  std::string object_file;  ///< object YAML; `package://`, `file://` or a plain path
  SimulationConfig simulation;
  double rate_hz = 30.0;             ///< images per second of ROS time, [1, 120]
  double wait_for_tracker_s = 20.0;  ///< the object rests until somebody listens to ~initial_pose, at most this long
  double init_error_m = 0.005;       ///< of the pose that is given to the tracker
  double init_error_rad = 0.07;
  std::vector<std::string>
      problems;  ///< one sentence each, naming parameter, value and what is allowed; empty = all good
};

/// Reads `object_file, robot_urdf, fiducials_file, scenario, speed, occluders, seed, rate_hz, wait_for_tracker_s,
/// init_error_m, init_error_rad`.
SimulatorOptions loadSimulatorOptions(const ros::NodeHandle& private_node);

}  // namespace depth_object_tracker
