// SPDX-License-Identifier: BSD-3-Clause
// Writes a BOP scene as a rosbag, as a depth camera and a robot would have sent it.
#include "scene_bag_writer.h"

#include <depth_object_tracker/Grasp.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

constexpr double kSmallestRealStampS = 1e8;  // 1973: earlier stamps count from the start of a recording
const ros::Duration kRobotIsAhead(0.001);    // the robot speaks just before the camera: a player keeps that order

template <typename Message>
boost::shared_ptr<ros::M_string> latchedHeader() {
  auto header = boost::make_shared<ros::M_string>();
  (*header)["type"] = ros::message_traits::datatype<Message>();
  (*header)["md5sum"] = ros::message_traits::md5sum<Message>();
  (*header)["message_definition"] = ros::message_traits::definition<Message>();
  (*header)["callerid"] = "/scene_to_bag";
  (*header)["latching"] = "1";
  return header;
}

sensor_msgs::CameraInfo toCameraInfo(const PinholeCamera& camera, const ros::Time& stamp) {
  sensor_msgs::CameraInfo info;
  info.header.stamp = stamp;
  info.header.frame_id = SceneBagWriter::kFrame;
  info.width = static_cast<std::uint32_t>(camera.width);
  info.height = static_cast<std::uint32_t>(camera.height);
  info.distortion_model = "plumb_bob";
  info.D.assign(5, 0.0);
  info.K = {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0};
  info.R = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  info.P = {camera.fx, 0.0, camera.cx, 0.0, 0.0, camera.fy, camera.cy, 0.0, 0.0, 0.0, 1.0, 0.0};
  return info;
}

geometry_msgs::PoseStamped toPoseMessage(const Pose& pose, const ros::Time& stamp) {
  const Eigen::Quaterniond q(pose.linear());
  geometry_msgs::PoseStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = SceneBagWriter::kFrame;
  message.pose.position.x = pose.translation().x();
  message.pose.position.y = pose.translation().y();
  message.pose.position.z = pose.translation().z();
  message.pose.orientation.x = q.x();
  message.pose.orientation.y = q.y();
  message.pose.orientation.z = q.z();
  message.pose.orientation.w = q.w();
  return message;
}

}  // namespace

SceneBagWriter::SceneBagWriter(const std::string& path, double first_stamp_s)
    : epoch_s_(first_stamp_s < kSmallestRealStampS ? kEpochS : 0) {
  bag_.open(path, rosbag::bagmode::Write);
  bag_.setCompression(rosbag::compression::LZ4);
}

ros::Time SceneBagWriter::toTime(double stamp_s) const {
  constexpr std::int64_t kNanosecondsPerSecond = 1000000000;
  const double whole_s = std::floor(stamp_s);
  const std::int64_t ns = std::llround((stamp_s - whole_s) * 1e9);
  const std::int64_t s = epoch_s_ + static_cast<std::int64_t>(whole_s) + ns / kNanosecondsPerSecond;
  return {static_cast<std::uint32_t>(s), static_cast<std::uint32_t>(ns % kNanosecondsPerSecond)};
}

void SceneBagWriter::write(const SceneFrame& frame, const DepthPicture& picture, const PinholeCamera& camera) {
  const ros::Time stamp = toTime(frame.stamp_s);
  writeGrasp(frame, stamp);
  writeTwist(frame, stamp);
  bag_.write("/camera/depth/camera_info", stamp, toCameraInfo(camera, stamp));
  writeImage(frame, picture, stamp);
  if (!frame.T_camera_object_truth) return;
  bag_.write("/ground_truth/pose", stamp, toPoseMessage(*frame.T_camera_object_truth, stamp));
}

void SceneBagWriter::writeGrasp(const SceneFrame& frame, const ros::Time& stamp) {
  const bool grasped = frame.control.has_value();
  if (last_grasped_ == grasped) return;
  last_grasped_ = grasped;
  Grasp message;
  message.header.stamp = stamp;
  message.header.frame_id = kFrame;
  message.grasped = grasped;
  bag_.write("/grasp", stamp - kRobotIsAhead, message, latchedHeader<Grasp>());
}

void SceneBagWriter::writeTwist(const SceneFrame& frame, const ros::Time& stamp) {
  if (!frame.control || !frame.control->has_twist) return;
  geometry_msgs::TwistStamped message;
  message.header.stamp = stamp;  // end of the interval that it covers
  message.header.frame_id = kFrame;
  message.twist.linear.x = frame.control->linear_m_s.x();
  message.twist.linear.y = frame.control->linear_m_s.y();
  message.twist.linear.z = frame.control->linear_m_s.z();
  message.twist.angular.x = frame.control->angular_rad_s.x();
  message.twist.angular.y = frame.control->angular_rad_s.y();
  message.twist.angular.z = frame.control->angular_rad_s.z();
  bag_.write("/control_twist", stamp - kRobotIsAhead, message);
}

std::uint16_t SceneBagWriter::toMillimetres(std::uint16_t count, double unit_mm) {
  if (count == 0) return 0;
  ++loss_.readings;
  const double exact_mm = unit_mm * count;
  const double rounded_mm = std::round(exact_mm);
  if (rounded_mm < 1.0 || rounded_mm > 65535.0) {
    ++loss_.out_of_range;
    return 0;
  }
  const double error_mm = std::abs(rounded_mm - exact_mm);
  loss_.sum_mm += error_mm;
  loss_.max_mm = std::max(loss_.max_mm, error_mm);
  return static_cast<std::uint16_t>(rounded_mm);
}

void SceneBagWriter::writeImage(const SceneFrame& frame, const DepthPicture& picture, const ros::Time& stamp) {
  sensor_msgs::Image image;
  image.header.stamp = stamp;
  image.header.frame_id = kFrame;
  image.width = static_cast<std::uint32_t>(picture.width);
  image.height = static_cast<std::uint32_t>(picture.height);
  image.encoding = "16UC1";
  image.is_bigendian = 0;
  image.step = 2 * image.width;
  image.data.resize(2 * picture.counts.size());
  const double unit_mm = 1e3 * frame.depth_unit_m;
  for (std::size_t i = 0; i < picture.counts.size(); ++i) {
    const std::uint16_t mm = toMillimetres(picture.counts[i], unit_mm);
    image.data[2 * i] = static_cast<std::uint8_t>(mm & 0xff);
    image.data[2 * i + 1] = static_cast<std::uint8_t>(mm >> 8);
  }
  bag_.write("/camera/depth/image_raw", stamp, image);
}

}  // namespace depth_object_tracker
