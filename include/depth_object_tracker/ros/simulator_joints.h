// SPDX-License-Identifier: BSD-3-Clause
// The simulated robot's joint states and commands, at the rate of a robot's driver.
#pragma once

#include "depth_object_tracker/simulator/robot_arm.h"

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <atomic>
#include <string>
#include <thread>

namespace depth_object_tracker {

/// Publishes on a thread of its own for as long as it lives.
class SimulatorJoints {
 public:
  static constexpr double kRateHz = 250.0;

  /// @param name_space absolute; `joint_states` and `joint_commands` lie below. @param robot outlives this object.
  SimulatorJoints(ros::NodeHandle node, const std::string& name_space, RobotArm& robot);
  ~SimulatorJoints();

  /// The arm rests before. May be called from any thread.
  void begin(const ros::Time& start) { start_s_ = start.toSec(); }

 private:
  void run();
  void publish(double stamp_s);

  RobotArm& robot_;
  ros::Publisher states_, commands_;
  std::atomic<double> start_s_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace depth_object_tracker
