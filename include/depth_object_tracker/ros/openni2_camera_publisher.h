// SPDX-License-Identifier: BSD-3-Clause
// Depth frames as ROS messages: images, camera_info, stamps; only what somebody listens to.
#pragma once

#include "depth_object_tracker/camera/depth_frame.h"
#include "depth_object_tracker/camera/device_clock.h"
#include "depth_object_tracker/ros/openni2_camera_options.h"

#include <camera_info_manager/camera_info_manager.h>
#include <image_transport/image_transport.h>
#include <ros/node_handle.h>
#include <sensor_msgs/CameraInfo.h>

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

namespace depth_object_tracker {

/// camera_info of a frame from the device's field of view: no distortion, principal point in the middle. Parts of an
/// image have their region of interest set.
sensor_msgs::CameraInfo factoryCameraInfo(const DepthFrame& frame);

/// Topics are those of openni2_camera: depth/image_raw (16UC1), depth/image (32FC1), depth/camera_info.
class OpenNI2CameraPublisher {
 public:
  /// @param name_space absolute; the topics lie below. @param on_demand is told when it begins and ends to be worth
  /// taking images; from any thread.
  OpenNI2CameraPublisher(ros::NodeHandle node, const std::string& name_space, const OpenNI2CameraOptions& options,
                         std::function<void(bool is_wanted)> on_demand);

  /// A device was opened: its clock and calibration are other ones. @param serial may be empty.
  void setDevice(const std::string& serial);

  /// For the camera's thread alone. The frame is copied at most once per topic that somebody listens to.
  void publish(const DepthFrame& frame);

  void setTimeOffset(double time_offset_s) { time_offset_s_ = time_offset_s; }

  /// Images made so far: tests see that nobody pays for what nobody wants.
  std::uint64_t numImages() const { return num_images_; }

 private:
  using Convert = void (*)(const DepthFrame&, std::vector<std::uint8_t>&);

  void onSubscribersChanged();
  ros::Time stampOf(const DepthFrame& frame);
  sensor_msgs::CameraInfo cameraInfo(const DepthFrame& frame);
  void publishImage(const image_transport::Publisher& publisher, const DepthFrame& frame,
                    const std_msgs::Header& header, const std::string& encoding, Convert convert);

  const OpenNI2CameraOptions options_;
  std::function<void(bool)> on_demand_;
  std::mutex demand_mutex_;  // subscribers may come before all topics are there
  std::unique_ptr<camera_info_manager::CameraInfoManager> calibration_;
  std::string serial_;  // of the device that is open
  image_transport::Publisher image_raw_, image_;
  ros::Publisher camera_info_;
  std::atomic<double> time_offset_s_;
  std::atomic<std::uint64_t> num_images_{0};
  bool has_warned_ = false;  // about a calibration for another size
  DeviceClock device_clock_;
  RecordingClock recording_clock_;
};

}  // namespace depth_object_tracker
