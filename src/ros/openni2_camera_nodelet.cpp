// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/openni2_camera_nodelet.h"

#include <exception>
#include <utility>

namespace depth_object_tracker {

OpenNI2CameraNodelet::~OpenNI2CameraNodelet() {
  reconfigure_.reset();
  std::unique_ptr<DepthCamera> camera;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    camera = std::move(camera_);
  }
  camera.reset();  // its thread uses the publisher; the publisher's subscribers ask for the camera
  publisher_.reset();
}

void OpenNI2CameraNodelet::onInit() {
  try {
    start();
  } catch (const std::exception& error) {
    NODELET_FATAL_STREAM(getName() << ": cannot start: " << error.what());
  }
}

void OpenNI2CameraNodelet::start() {
  options_ = loadOpenNI2CameraOptions(getPrivateNodeHandle());
  for (const std::string& problem : options_.problems) {
    NODELET_FATAL_STREAM(getName() << ": " << problem << ". The camera is not started; correct it and start again");
  }
  if (!options_.problems.empty()) return;
  if (ros::Time::isSimTime()) {
    NODELET_WARN_STREAM(getName() << ": /use_sim_time is set, left over from a bag? Images are stamped with simulated "
                                     "time; if that is not meant: rosparam set /use_sim_time false, and start again");
  }
  publishFrames();
  publisher_ = std::make_unique<OpenNI2CameraPublisher>(getNodeHandle(), ros::names::parentNamespace(getName()),
                                                        options_, [this](bool is_wanted) { onDemand(is_wanted); });
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    camera_ = std::make_unique<DepthCamera>(options_.camera, cameraEvents());
    camera_->setWanted(is_wanted_);
  }
  reconfigure_ = std::make_unique<dynamic_reconfigure::Server<OpenNI2CameraConfig>>(getPrivateNodeHandle());
  reconfigure_->setCallback([this](OpenNI2CameraConfig& config, std::uint32_t) { onReconfigure(config); });
}

DepthCameraEvents OpenNI2CameraNodelet::cameraEvents() {
  DepthCameraEvents events;
  events.on_frame = [this](const DepthFrame& frame) { publisher_->publish(frame); };
  events.on_open = [this](const DeviceDescription& device) { publisher_->setDevice(device.serial); };
  events.on_message = [name = getName()](DepthCameraEvents::Severity severity, const std::string& message) {
    using Severity = DepthCameraEvents::Severity;
    if (severity == Severity::kInfo) ROS_INFO_STREAM(name << ": " << message);
    if (severity == Severity::kWarning) ROS_WARN_STREAM(name << ": " << message);
    if (severity == Severity::kError) ROS_ERROR_STREAM(name << ": " << message);
  };
  return events;
}

void OpenNI2CameraNodelet::onDemand(bool is_wanted) {
  const std::lock_guard<std::mutex> lock(mutex_);
  is_wanted_ = is_wanted;
  if (camera_) camera_->setWanted(is_wanted);
}

void OpenNI2CameraNodelet::onReconfigure(const OpenNI2CameraConfig& config) {
  publisher_->setTimeOffset(config.time_offset_s);
  DepthCameraOptions options = options_.camera;
  options.mode = {config.width, config.height, config.fps};
  options.registration = config.registration;
  if (options.mode == options_.camera.mode && options.registration == options_.camera.registration) return;
  options_.camera = options;
  publishFrames();
  const std::lock_guard<std::mutex> lock(mutex_);
  if (camera_) camera_->setOptions(options);
}

/// Only the axes are turned: where the device sits on a robot is the robot's business.
void OpenNI2CameraNodelet::publishFrames() {
  if (options_.parent_frame_id.empty()) return;
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = ros::Time::now();
  transform.header.frame_id = options_.parent_frame_id;
  transform.child_frame_id = options_.camera.registration ? options_.rgb_frame_id : options_.depth_frame_id;
  transform.transform.rotation.x = -0.5;  // x forward, y left, z up to x right, y down, z forward (REP-103)
  transform.transform.rotation.y = 0.5;
  transform.transform.rotation.z = -0.5;
  transform.transform.rotation.w = 0.5;
  if (!frames_) frames_.emplace();
  frames_->sendTransform(transform);
}

}  // namespace depth_object_tracker
