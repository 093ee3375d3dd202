// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/simulator_publisher.h"

#include "depth_object_tracker/ros/message_conversions.h"
#include "depth_object_tracker/ros/particle_messages.h"

#include <depth_object_tracker/Grasp.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <image_transport/image_transport.h>
#include <sensor_msgs/image_encodings.h>
#include <boost/make_shared.hpp>

#include <algorithm>
#include <cstring>

namespace depth_object_tracker {
namespace {

// This machine's byte order: pixels are published as they lie in memory.
constexpr bool kIsBigEndian = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;

template <typename Pixel>
sensor_msgs::ImagePtr makeImage(const std::vector<Pixel>& pixels, const PinholeCamera& camera, const char* encoding,
                                const std_msgs::Header& header) {
  auto image = boost::make_shared<sensor_msgs::Image>();
  image->header = header;
  image->width = static_cast<std::uint32_t>(camera.width);
  image->height = static_cast<std::uint32_t>(camera.height);
  image->encoding = encoding;
  image->is_bigendian = kIsBigEndian;
  image->step = static_cast<std::uint32_t>(sizeof(Pixel)) * image->width;
  image->data.resize(sizeof(Pixel) * pixels.size());
  std::memcpy(image->data.data(), pixels.data(), image->data.size());
  return image;
}

geometry_msgs::TransformStamped frame(const char* parent, const char* child, const Pose& T_parent_child) {
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = ros::Time::now();
  transform.header.frame_id = parent;
  transform.child_frame_id = child;
  transform.transform = toTransformMessage(T_parent_child);
  return transform;
}

}  // namespace

SimulatorPublisher::SimulatorPublisher(ros::NodeHandle node, ros::NodeHandle private_node,
                                       const std::string& name_space, const SimulationConfig& config)
    : config_(config) {
  const auto topic = [&](const char* name) { return ros::names::append(name_space, name); };
  camera_ = image_transport::ImageTransport(node).advertiseCamera(topic("camera/depth/image_raw"), 2);
  camera_info_ = *toCameraInfo(config.camera, std_msgs::Header());
  if (!config.fiducials_file.empty()) {
    left_ = image_transport::ImageTransport(node).advertiseCamera(topic("stereo/left/image_rect"), 2);
    right_ = image_transport::ImageTransport(node).advertiseCamera(topic("stereo/right/image_rect"), 2);
  }
  truth_ = node.advertise<geometry_msgs::PoseStamped>(topic("ground_truth/pose"), 10);
  occlusion_ = node.advertise<sensor_msgs::Image>(topic("ground_truth/occlusion"), 2);
  initial_pose_ = private_node.advertise<geometry_msgs::PoseWithCovarianceStamped>("initial_pose", 1, true);
  if (config.scenario == Scenario::kRobot || config.scenario == Scenario::kSlip) {
    control_twist_ = node.advertise<geometry_msgs::TwistStamped>(topic("control_twist"), 30);
    grasp_ = node.advertise<Grasp>(topic("grasp"), 1, true);
  }
}

void SimulatorPublisher::setRobot(const std::string& root_link, const Pose& T_world_base,
                                  const std::string& hand_link) {
  root_link_ = root_link;
  T_world_base_ = T_world_base;
  hand_link_ = hand_link;
}

void SimulatorPublisher::publishFrames() {
  const CameraMount mount = makeCameraMount(config_);
  std::vector<geometry_msgs::TransformStamped> frames{
      frame(kWorldFrame, kCameraLinkFrame, mount.T_world_link),
      frame(kCameraLinkFrame, kCameraOpticalFrame, mount.T_link_camera)};
  if (!config_.fiducials_file.empty()) {
    Pose T_camera_left = Pose::Identity();
    T_camera_left.translation() =
        Eigen::Vector3d(config_.stereo.left_x_m, config_.stereo.left_y_m, config_.stereo.left_z_m);
    frames.push_back(frame(kCameraOpticalFrame, kStereoLeftFrame, T_camera_left));
  }
  if (!root_link_.empty()) frames.push_back(frame(kWorldFrame, root_link_.c_str(), T_world_base_));
  frames_.sendTransform(frames);
}

void SimulatorPublisher::publishInitialPose(const Pose& T_camera_object, double error_m, double error_rad) {
  auto pose = boost::make_shared<geometry_msgs::PoseWithCovarianceStamped>();
  pose->header.frame_id = kCameraOpticalFrame;
  Matrix6d covariance = Matrix6d::Zero();
  covariance.diagonal().head<3>().setConstant(std::max(error_m * error_m, 1e-6));
  covariance.diagonal().tail<3>().setConstant(std::max(error_rad * error_rad, 1e-5));
  pose->pose = toPoseMessage(T_camera_object, covariance);
  initial_pose_.publish(pose);
}

void SimulatorPublisher::publishGrasp(const ros::Time& stamp) {
  if (!grasp_) return;
  auto grasp = boost::make_shared<Grasp>();
  grasp->header.stamp = stamp;
  grasp->header.frame_id = kCameraOpticalFrame;
  grasp->grasped = true;
  grasp->link = hand_link_;
  grasp_.publish(grasp);
}

void SimulatorPublisher::publish(const SimulatedFrame& frame, const ros::Time& stamp) {
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = kCameraOpticalFrame;
  // The command first: whoever waits for the image's command has it then.
  if (frame.control) publishControl(*frame.control, header);
  publishImage(frame, header);
  publishStereo(frame, stamp);
  publishTruth(frame, header);
}

/// As stereo_image_proc does: both pictures carry the left camera's frame; the right P tells the baseline.
void SimulatorPublisher::publishStereo(const SimulatedFrame& frame, const ros::Time& stamp) {
  if (frame.left.empty() || !isStereoWanted()) return;
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = kStereoLeftFrame;
  const auto left_info = toCameraInfo(config_.stereo.camera, header);
  const auto right_info = boost::make_shared<sensor_msgs::CameraInfo>(*left_info);
  right_info->P[3] = -right_info->P[0] * config_.stereo.baseline_m;
  const std::string& encoding = sensor_msgs::image_encodings::MONO8;
  left_.publish(makeImage(frame.left, config_.stereo.camera, encoding.c_str(), header), left_info);
  right_.publish(makeImage(frame.right, config_.stereo.camera, encoding.c_str(), header), right_info);
}

void SimulatorPublisher::publishImage(const SimulatedFrame& frame, const std_msgs::Header& header) {
  if (camera_.getNumSubscribers() == 0) return;
  auto info = boost::make_shared<sensor_msgs::CameraInfo>(camera_info_);
  info->header = header;
  camera_.publish(makeImage(frame.depth_mm, config_.camera, sensor_msgs::image_encodings::TYPE_16UC1.c_str(), header),
                  info);
}

void SimulatorPublisher::publishTruth(const SimulatedFrame& frame, const std_msgs::Header& header) {
  auto pose = boost::make_shared<geometry_msgs::PoseStamped>();
  pose->header = header;
  pose->pose = toPoseMessage(frame.T_camera_object);
  truth_.publish(pose);
  if (occlusion_.getNumSubscribers() == 0) return;
  occlusion_.publish(makeImage(frame.occlusion, config_.camera, sensor_msgs::image_encodings::MONO8.c_str(), header));
}

void SimulatorPublisher::publishControl(const ControlInput& control, const std_msgs::Header& header) {
  auto twist = boost::make_shared<geometry_msgs::TwistStamped>();
  twist->header = header;
  const Eigen::Vector3d &linear = control.linear_m_s, &angular = control.angular_rad_s;
  twist->twist.linear.x = linear.x();
  twist->twist.linear.y = linear.y();
  twist->twist.linear.z = linear.z();
  twist->twist.angular.x = angular.x();
  twist->twist.angular.y = angular.y();
  twist->twist.angular.z = angular.z();
  control_twist_.publish(twist);
}

}  // namespace depth_object_tracker
