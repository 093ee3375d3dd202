// SPDX-License-Identifier: BSD-3-Clause
#include "bag_recording.h"

#include "depth_object_tracker/tools/input_error.h"

#include <geometry_msgs/PoseStamped.h>
#include <image_transport/camera_common.h>
#include <rosbag/view.h>

#include <cmath>
#include <vector>

namespace depth_object_tracker {
namespace {

constexpr const char* kTruthTopic = "/ground_truth/pose";
constexpr double kSameStampS = 1e-3;

bool isDepth(const std::string& topic) {
  return topic.find("depth") != std::string::npos;
}

/// Of several image topics the only one that calls itself depth.
std::string onlyDepthTopic(const std::vector<std::string>& topics) {
  if (topics.size() == 1) return topics.front();
  std::string only;
  for (const std::string& topic : topics) {
    if (!isDepth(topic)) continue;
    if (!only.empty()) return "";
    only = topic;
  }
  return only;
}

std::string join(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::optional<Pose> toPose(const geometry_msgs::Pose& message) {
  const Eigen::Quaterniond q(message.orientation.w, message.orientation.x, message.orientation.y,
                             message.orientation.z);
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(message.position.x, message.position.y, message.position.z);
  if (!(std::abs(q.norm() - 1.0) < 0.1) || !pose.translation().allFinite()) return std::nullopt;
  pose.linear() = q.normalized().toRotationMatrix();
  return pose;
}

}  // namespace

BagRecording::BagRecording(const std::string& path, const std::string& image_topic)
    : path_(path), image_topic_(image_topic) {
  try {
    bag_.open(path_, rosbag::bagmode::Read);
    chooseImageTopic();
    info_topic_ = image_transport::getCameraInfoTopic(image_topic_);
    readInfosAndTruth();
  } catch (const rosbag::BagUnindexedException&) {
    throw InputError(path_ + " has no index (its recording was cut off): rosbag reindex mends that");
  } catch (const rosbag::BagException& error) {
    throw InputError("cannot read " + path_ + " as a rosbag: " + error.what());
  }
}

void BagRecording::chooseImageTopic() {
  rosbag::View view(bag_, rosbag::TypeQuery("sensor_msgs/Image"));
  std::vector<std::string> topics;
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    if (topics.empty() || topics.back() != connection->topic) topics.push_back(connection->topic);
  }
  if (topics.empty()) throw InputError(path_ + " has no topic of sensor_msgs/Image (compressed images are not read)");
  if (image_topic_.empty()) image_topic_ = onlyDepthTopic(topics);
  if (image_topic_.empty())
    throw InputError("name the depth image with --image-topic; " + path_ + " has " + join(topics));
  num_images_ = rosbag::View(bag_, rosbag::TopicQuery(image_topic_)).size();
  if (num_images_ == 0) throw InputError(path_ + " has no image on " + image_topic_ + "; there is " + join(topics));
}

void BagRecording::readInfosAndTruth() {
  for (const auto& message :
       rosbag::View(bag_, rosbag::TopicQuery(std::vector<std::string>{info_topic_, kTruthTopic}))) {
    if (const auto info = message.instantiate<sensor_msgs::CameraInfo>()) {
      infos_[info->header.stamp] = info;
    } else if (const auto truth = message.instantiate<geometry_msgs::PoseStamped>()) {
      if (const auto pose = toPose(truth->pose)) truths_[truth->header.stamp] = *pose;
    }
  }
}

sensor_msgs::CameraInfoConstPtr BagRecording::infoFor(const ros::Time& stamp) const {
  if (infos_.empty()) return nullptr;
  const auto after = infos_.upper_bound(stamp);
  return after == infos_.begin() ? after->second : std::prev(after)->second;
}

std::optional<Pose> BagRecording::truthAt(const ros::Time& stamp) const {
  const auto found = truths_.lower_bound(stamp - ros::Duration(kSameStampS));
  if (found == truths_.end() || found->first > stamp + ros::Duration(kSameStampS)) return std::nullopt;
  return found->second;
}

std::optional<Pose> BagRecording::firstTruth() const {
  if (truths_.empty()) return std::nullopt;
  return truths_.begin()->second;
}

void BagRecording::forEach(const std::function<void(const rosbag::MessageInstance&)>& take) const {
  rosbag::View view(bag_);
  for (const auto& message : view) take(message);
}

}  // namespace depth_object_tracker
