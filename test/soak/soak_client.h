// SPDX-License-Identifier: BSD-3-Clause
// The camera, the robot and the user of a soaked tracker nodelet. Keeps no message but the newest.
#pragma once

#include "soak_scene.h"

#include <depth_object_tracker/TrackerStatus.h>
#include <nodelet/loader.h>
#include <ros/ros.h>

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

namespace depth_object_tracker {

class SoakClient {
 public:
  /// Loads the nodelet into this process and waits until it is connected.
  /// @throws std::runtime_error when that does not happen.
  explicit SoakClient(const std::string& nodelet);
  ~SoakClient();

  /// Publishes an image and waits for the status that counts it.
  /// @return false after a minute without: a deadlock.
  bool send(const std::vector<float>& depth_m, const Vector6d& twist, TrackerStatus& status);

  // Each returns whether the service answered, whatever it said.
  bool initialiseAt(const Pose& T_camera_object);
  bool initialiseAnywhere();
  bool loadObject(const std::string& mesh_uri);
  bool reset();
  bool setPaused(bool paused);

  void setGrasp(bool grasped);
  void jumpBack(double seconds) { stamp_ -= ros::Duration(seconds); }

 private:
  template <typename Service>
  bool call(const std::string& name, Service& service);

  std::string name_;
  ros::NodeHandle node_;
  ros::Publisher images_, infos_, grasps_, twists_;
  ros::Subscriber statuses_;
  nodelet::Loader loader_;
  ros::Time stamp_{1000000.0};
  std::uint64_t num_sent_ = 0;
  std::mutex mutex_;  // guards newest_
  std::condition_variable arrived_;
  TrackerStatusConstPtr newest_;
};

}  // namespace depth_object_tracker
