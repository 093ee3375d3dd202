// SPDX-License-Identifier: BSD-3-Clause
// Pairs images with camera_info: by stamp where the camera publishes both, else with the newest one.
#pragma once

#include "depth_object_tracker/ros/frame_inbox.h"

#include <deque>
#include <functional>
#include <utility>

namespace depth_object_tracker {

/// Image and camera_info arrive in any order. An image waits for the camera_info of its own stamp only until the next
/// image comes; from then on images go out at once with the newest camera_info until stamps match again. So a
/// camera_info that is published once, latched, or late never stops the stream. Not thread-safe: both callbacks on one
/// queue.
class CameraInfoMatcher {
 public:
  using Output = std::function<void(CameraFrame)>;
  explicit CameraInfoMatcher(Output output) : output_(std::move(output)) {}

  void addImage(const sensor_msgs::ImageConstPtr& image);
  void addInfo(const sensor_msgs::CameraInfoConstPtr& info);

 private:
  sensor_msgs::CameraInfoConstPtr findInfo(const ros::Time& stamp) const;
  void flushWaiting(const sensor_msgs::CameraInfoConstPtr& info);

  static constexpr std::size_t kKeptInfos = 4;
  Output output_;
  std::deque<sensor_msgs::CameraInfoConstPtr> infos_;  // newest last
  CameraFrame waiting_;                                // image null: nothing waits
  ros::Time last_image_stamp_;
  bool stamps_match_ = true;  // whether waiting for the exact stamp is worth it
};

}  // namespace depth_object_tracker
