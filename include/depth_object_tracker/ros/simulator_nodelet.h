// SPDX-License-Identifier: BSD-3-Clause
// A simulated depth camera as a nodelet: stands in for a camera driver.
#pragma once

#include "depth_object_tracker/ros/simulator_joints.h"
#include "depth_object_tracker/ros/simulator_options.h"
#include "depth_object_tracker/ros/simulator_publisher.h"

#include <nodelet/nodelet.h>

#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

namespace depth_object_tracker {

/// One thread renders and publishes at the camera's rate by ROS time. When it cannot keep the rate it leaves images
/// out, as a camera would, and says so.
class SimulatorNodelet : public nodelet::Nodelet {
 public:
  ~SimulatorNodelet() override;

 private:
  void onInit() override;
  void run();
  void publishImages(SceneSimulator& simulator);
  ros::Time waitForTracker(SceneSimulator& simulator);
  /// @return false when the nodelet is to end.
  bool sleepUntil(const ros::Time& time);
  void reportRate(const ros::Time& now);

  SimulatorOptions options_;
  std::optional<SimulatorPublisher> publisher_;
  std::optional<SimulatorJoints> joints_;  // the thread's
  std::mutex mutex_;                       // guards stop_
  std::condition_variable stopped_;
  bool stop_ = false;
  ros::Time report_since_;
  int published_ = 0;
  int missed_ = 0;
  std::thread thread_;
};

}  // namespace depth_object_tracker
