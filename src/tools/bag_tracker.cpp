// SPDX-License-Identifier: BSD-3-Clause
#include "bag_tracker.h"

#include "bag_recording.h"

#include <depth_object_tracker/Grasp.h>
#include <geometry_msgs/TwistStamped.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/JointState.h>
#include <tf2/exceptions.h>
#include <tf2_msgs/TFMessage.h>

#include <utility>

namespace depth_object_tracker {
namespace {

FrameOptions framesWithoutWaiting() {
  FrameOptions frames;
  frames.transform_wait_s = 0.0;  // what the bag holds is there already
  return frames;
}

/// The time of the recording in place of the machine's.
std::chrono::steady_clock::time_point asClock(const ros::Time& time) {
  using Clock = std::chrono::steady_clock;
  return Clock::time_point(std::chrono::duration_cast<Clock::duration>(std::chrono::nanoseconds(time.toNSec())));
}

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

}  // namespace

BagTracker::BagTracker(const BagRecording& recording, Output output)
    : recording_(recording),
      output_(std::move(output)),
      session_("track_bag", recording.imageTopic(), recording.infoTopic(), tf_) {
  session_.setFrames(framesWithoutWaiting());
}

void BagTracker::run() {
  recording_.forEach([this](const rosbag::MessageInstance& message) {
    takeWaitingBefore(message.getTime() - ros::Duration(std::min(kLookAheadS, message.getTime().toSec())));
    if (!takeAtOnce(message)) waiting_.push_back({message.getTime(), message});
  });
  takeWaitingBefore(ros::TIME_MAX);
}

/// @return false for what has to keep its place among the images.
bool BagTracker::takeAtOnce(const rosbag::MessageInstance& message) {
  const std::string& topic = message.getTopic();
  if (topic == recording_.imageTopic() || message.isType<Grasp>()) return false;
  if (topic == "/tf" || topic == "/tf_static") {
    takeTransforms(message, topic == "/tf_static");
  } else if (endsWith(topic, "/control_twist")) {
    if (const auto twist = message.instantiate<geometry_msgs::TwistStamped>()) session_.addTwist(*twist);
  } else if (endsWith(topic, "/joint_states")) {
    if (const auto joints = message.instantiate<sensor_msgs::JointState>()) session_.addJointStates(*joints);
  } else if (endsWith(topic, "/joint_commands")) {
    if (const auto joints = message.instantiate<sensor_msgs::JointState>()) session_.addCommands(*joints);
  }
  return true;
}

void BagTracker::takeTransforms(const rosbag::MessageInstance& message, bool is_static) {
  const auto transforms = message.instantiate<tf2_msgs::TFMessage>();
  if (!transforms) return;
  for (const geometry_msgs::TransformStamped& transform : transforms->transforms) {
    tf_.setTransform(transform, "bag", is_static);  // says itself what is wrong with one
  }
}

void BagTracker::takeWaitingBefore(const ros::Time& time) {
  while (!waiting_.empty() && waiting_.front().recorded_at < time) {
    takeWaiting(waiting_.front().message);
    waiting_.pop_front();
  }
}

void BagTracker::takeWaiting(const rosbag::MessageInstance& message) {
  if (const auto grasp = message.instantiate<Grasp>()) {
    const bool is_meant = grasp->object_name.empty() || grasp->object_name == session_.object().name;
    if (is_meant) session_.setGrasp(grasp->grasped, grasp->link);
    return;
  }
  const auto image = message.instantiate<sensor_msgs::Image>();
  if (!image) return;
  ros::Time::setNow(message.getTime());
  output_(session_.process({image, recording_.infoFor(image->header.stamp), asClock(message.getTime())}),
          message.getTime());
}

}  // namespace depth_object_tracker
