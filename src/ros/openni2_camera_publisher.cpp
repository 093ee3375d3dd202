// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/openni2_camera_publisher.h"

#include <ros/console.h>
#include <sensor_msgs/distortion_models.h>
#include <sensor_msgs/image_encodings.h>
#include <boost/make_shared.hpp>

#include <cctype>
#include <utility>

namespace depth_object_tracker {
namespace {

constexpr bool kIsBigEndian = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;

/// Names of calibrations hold letters, digits and underscores.
std::string calibrationName(const std::string& serial) {
  std::string name = "depth_" + (serial.empty() ? "camera" : serial);
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}

void setRegionOfInterest(const DepthFrame& frame, sensor_msgs::CameraInfo& info) {
  if (frame.width == frame.full_width && frame.height == frame.full_height) return;
  const int last_column = frame.column_offset + frame.width;
  const int column = frame.is_mirrored ? frame.full_width - last_column : frame.column_offset;
  info.roi.x_offset = static_cast<std::uint32_t>(column);
  info.roi.y_offset = static_cast<std::uint32_t>(frame.row_offset);
  info.roi.width = static_cast<std::uint32_t>(frame.width);
  info.roi.height = static_cast<std::uint32_t>(frame.height);
}

}  // namespace

sensor_msgs::CameraInfo factoryCameraInfo(const DepthFrame& frame) {
  const double f = factoryFocalLengthPx(frame);
  const double cx = 0.5 * (frame.full_width - 1), cy = 0.5 * (frame.full_height - 1);
  sensor_msgs::CameraInfo info;
  info.width = static_cast<std::uint32_t>(frame.full_width);
  info.height = static_cast<std::uint32_t>(frame.full_height);
  info.distortion_model = sensor_msgs::distortion_models::PLUMB_BOB;
  info.D.assign(5, 0.0);
  info.K = {f, 0.0, cx, 0.0, f, cy, 0.0, 0.0, 1.0};
  info.R = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  info.P = {f, 0.0, cx, 0.0, 0.0, f, cy, 0.0, 0.0, 0.0, 1.0, 0.0};
  setRegionOfInterest(frame, info);
  return info;
}

OpenNI2CameraPublisher::OpenNI2CameraPublisher(ros::NodeHandle node, const std::string& name_space,
                                               const OpenNI2CameraOptions& options,
                                               std::function<void(bool is_wanted)> on_demand)
    : options_(options),
      on_demand_(std::move(on_demand)),
      time_offset_s_(options.time_offset_s),
      recording_clock_(options.camera.playback_speed == 1.0) {
  const std::string depth = ros::names::append(name_space, "depth");
  const std::string name = options.camera_name.empty() ? calibrationName("") : options.camera_name;
  calibration_ = std::make_unique<camera_info_manager::CameraInfoManager>(ros::NodeHandle(node, depth), name,
                                                                          options.camera_info_url);
  const std::lock_guard<std::mutex> lock(demand_mutex_);
  image_transport::ImageTransport images(node);
  const auto on_change = [this](const image_transport::SingleSubscriberPublisher&) { onSubscribersChanged(); };
  image_raw_ = images.advertise(depth + "/image_raw", 2, on_change, on_change);
  image_ = images.advertise(depth + "/image", 2, on_change, on_change);
  const auto on_info = [this](const ros::SingleSubscriberPublisher&) { onSubscribersChanged(); };
  camera_info_ = node.advertise<sensor_msgs::CameraInfo>(depth + "/camera_info", 2, on_info, on_info);
}

void OpenNI2CameraPublisher::onSubscribersChanged() {
  const std::lock_guard<std::mutex> lock(demand_mutex_);
  // A recording is not to start before those who want its images are there.
  const bool counts_info = !isRecording(options_.camera.device);
  on_demand_(image_raw_.getNumSubscribers() > 0 || image_.getNumSubscribers() > 0 ||
             (counts_info && camera_info_.getNumSubscribers() > 0));
}

void OpenNI2CameraPublisher::setDevice(const std::string& serial) {
  device_clock_.reset();
  if (!options_.camera_name.empty() || serial == serial_) return;  // it reads, and talks about, a file
  serial_ = serial;
  calibration_->setCameraName(calibrationName(serial));
}

void OpenNI2CameraPublisher::publish(const DepthFrame& frame) {
  std_msgs::Header header;
  header.stamp = stampOf(frame);
  header.frame_id = frame.is_registered ? options_.rgb_frame_id : options_.depth_frame_id;
  auto info = boost::make_shared<sensor_msgs::CameraInfo>(cameraInfo(frame));
  info->header = header;
  camera_info_.publish(info);  // first: whoever waits for it to use the image has it then
  publishImage(image_raw_, frame, header, sensor_msgs::image_encodings::TYPE_16UC1, copyMillimetres);
  publishImage(image_, frame, header, sensor_msgs::image_encodings::TYPE_32FC1, copyMetres);
}

void OpenNI2CameraPublisher::publishImage(const image_transport::Publisher& publisher, const DepthFrame& frame,
                                          const std_msgs::Header& header, const std::string& encoding,
                                          Convert convert) {
  if (publisher.getNumSubscribers() == 0) return;
  auto image = boost::make_shared<sensor_msgs::Image>();
  image->header = header;
  image->width = static_cast<std::uint32_t>(frame.width);
  image->height = static_cast<std::uint32_t>(frame.height);
  image->encoding = encoding;
  image->is_bigendian = kIsBigEndian;
  convert(frame, image->data);
  image->step = static_cast<std::uint32_t>(image->data.size()) / image->height;
  ++num_images_;
  publisher.publish(image);
}

ros::Time OpenNI2CameraPublisher::stampOf(const DepthFrame& frame) {
  const double arrival_s = ros::Time::now().toSec();
  const double stamp_s = isRecording(options_.camera.device)
                             ? recording_clock_.toReceiverTime(frame.timestamp_s, arrival_s)
                             : device_clock_.toReceiverTime(frame.timestamp_s, arrival_s);
  return ros::Time(std::max(0.0, stamp_s + time_offset_s_));
}

sensor_msgs::CameraInfo OpenNI2CameraPublisher::cameraInfo(const DepthFrame& frame) {
  sensor_msgs::CameraInfo factory = factoryCameraInfo(frame);
  if (!calibration_->isCalibrated()) return factory;
  sensor_msgs::CameraInfo calibrated = calibration_->getCameraInfo();
  if (calibrated.width != factory.width || calibrated.height != factory.height) {
    if (!std::exchange(has_warned_, true)) {
      ROS_WARN_STREAM("the calibration is for images of " << calibrated.width << "x" << calibrated.height
                                                          << " but the camera's have " << factory.width << "x"
                                                          << factory.height << ": taking the factory's model");
    }
    return factory;
  }
  has_warned_ = false;
  calibrated.roi = factory.roi;
  return calibrated;
}

}  // namespace depth_object_tracker
