// SPDX-License-Identifier: BSD-3-Clause
// depth_object_tracker/OpenNI2Camera: an OpenNI2 depth camera or .oni recording as ROS topics.
#pragma once

#include "depth_object_tracker/camera/depth_camera.h"
#include "depth_object_tracker/ros/openni2_camera_publisher.h"

#include <depth_object_tracker/OpenNI2CameraConfig.h>
#include <dynamic_reconfigure/server.h>
#include <nodelet/nodelet.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <memory>
#include <mutex>
#include <optional>

namespace depth_object_tracker {

class OpenNI2CameraNodelet : public nodelet::Nodelet {
 public:
  ~OpenNI2CameraNodelet() override;

 private:
  void onInit() override;
  void start();
  DepthCameraEvents cameraEvents();
  void onDemand(bool is_wanted);
  void onReconfigure(const OpenNI2CameraConfig& config);
  void publishFrames();

  OpenNI2CameraOptions options_;
  std::optional<tf2_ros::StaticTransformBroadcaster> frames_;
  std::unique_ptr<OpenNI2CameraPublisher> publisher_;

  std::mutex mutex_;  // guards the camera's pointer and whether it is wanted
  bool is_wanted_ = false;
  std::unique_ptr<DepthCamera> camera_;
  std::unique_ptr<dynamic_reconfigure::Server<OpenNI2CameraConfig>> reconfigure_;
};

}  // namespace depth_object_tracker
