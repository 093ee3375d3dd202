// SPDX-License-Identifier: BSD-3-Clause
#include "soak_client.h"

#include "../ros/depth_messages.h"
#include "slowness.h"

#include "depth_object_tracker/ros/message_conversions.h"

#include <depth_object_tracker/Grasp.h>
#include <depth_object_tracker/InitializeTracker.h>
#include <depth_object_tracker/LoadObject.h>
#include <geometry_msgs/TwistStamped.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <chrono>
#include <stdexcept>

namespace depth_object_tracker {
namespace {

constexpr const char* kFrame = "camera_depth_optical_frame";
const std::chrono::duration<double> kPatience(60.0 * kSlowness);

}  // namespace

SoakClient::SoakClient(const std::string& nodelet)
    : name_(nodelet),
      images_(node_.advertise<sensor_msgs::Image>("/camera/depth/image_raw", 2)),
      infos_(node_.advertise<sensor_msgs::CameraInfo>("/camera/depth/camera_info", 2)),
      grasps_(node_.advertise<Grasp>("/grasp", 2)),
      twists_(node_.advertise<geometry_msgs::TwistStamped>("/control_twist", 10)),
      loader_(false) {
  const boost::function<void(const TrackerStatusConstPtr&)> take = [this](const TrackerStatusConstPtr& status) {
    const std::lock_guard<std::mutex> lock(mutex_);
    newest_ = status;
    arrived_.notify_all();
  };
  statuses_ = node_.subscribe<TrackerStatus>(name_ + "/status", 10, take);
  const nodelet::M_string remappings{{ros::names::resolve("depth/image"), "/camera/depth/image_raw"}};
  if (!loader_.load(name_, "depth_object_tracker/Tracker", remappings, {})) {
    throw std::runtime_error("the nodelet cannot be loaded");
  }
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(60.0);
  while (images_.getNumSubscribers() == 0 || infos_.getNumSubscribers() == 0 || twists_.getNumSubscribers() == 0) {
    if (ros::WallTime::now() > deadline) throw std::runtime_error("the nodelet does not subscribe");
    ros::WallDuration(0.01).sleep();
  }
}

SoakClient::~SoakClient() {
  loader_.unload(name_);
}

bool SoakClient::send(const std::vector<float>& depth_m, const Vector6d& twist, TrackerStatus& status) {
  stamp_ += ros::Duration(SoakScene::kFrameS);
  const PinholeCamera lens = SoakScene::camera();
  auto moved = boost::make_shared<geometry_msgs::TwistStamped>();
  moved->header.stamp = stamp_;
  moved->header.frame_id = kFrame;
  for (int i = 0; i < 3; ++i) {
    (&moved->twist.linear.x)[i] = twist(i);
    (&moved->twist.angular.x)[i] = twist(3 + i);
  }
  twists_.publish(moved);
  const auto info = makeCameraInfo(lens);
  info->header.stamp = stamp_;
  infos_.publish(info);
  const auto image = makeUint16Image(depth_m, lens.width, lens.height);
  image->header.stamp = stamp_;
  images_.publish(sensor_msgs::ImageConstPtr(image));
  ++num_sent_;
  std::unique_lock<std::mutex> lock(mutex_);
  const bool answered = arrived_.wait_for(lock, kPatience, [this] {
    return newest_ && newest_->frames_received >= num_sent_ && newest_->header.stamp == stamp_;
  });
  if (answered) status = *newest_;
  return answered;
}

template <typename Service>
bool SoakClient::call(const std::string& name, Service& service) {
  return ros::service::call(name_ + "/" + name, service);
}

bool SoakClient::initialiseAt(const Pose& T_camera_object) {
  InitializeTracker service;
  service.request.mode = InitializeTracker::Request::FROM_POSE;
  service.request.pose.header.frame_id = kFrame;
  service.request.pose.pose.pose = toPoseMessage(T_camera_object);
  return call("initialize", service);
}

bool SoakClient::initialiseAnywhere() {
  InitializeTracker service;
  service.request.mode = InitializeTracker::Request::GLOBAL;
  return call("initialize", service);
}

bool SoakClient::loadObject(const std::string& mesh_uri) {
  LoadObject service;
  service.request.mesh = mesh_uri;
  return call("load_object", service) && service.response.success;
}

bool SoakClient::reset() {
  std_srvs::Trigger service;
  return call("reset", service);
}

bool SoakClient::setPaused(bool paused) {
  std_srvs::SetBool service;
  service.request.data = paused;
  return call("pause", service);
}

void SoakClient::setGrasp(bool grasped) {
  const auto message = boost::make_shared<Grasp>();
  message->header.stamp = stamp_;
  message->grasped = grasped;
  grasps_.publish(message);
}

}  // namespace depth_object_tracker
