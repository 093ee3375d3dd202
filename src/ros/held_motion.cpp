// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/held_motion.h"

#include "depth_object_tracker/ros/message_conversions.h"

#include <tf2/exceptions.h>

namespace depth_object_tracker {
namespace {

constexpr double kLiveTwistAgeS = 0.2;  // a stream of twists that is older than this has ended

}  // namespace

std::string HeldMotion::findLinkProblem(const std::string& link) const {
  if (link.empty()) return "";
  if (robot_.connection) return robot_.connection->findLinkProblem(link);
  if (!robot_.problem.empty()) return robot_.problem;
  return "the motion of link '" + link +
         "' is not known: ~robot is false. Set it to true with the robot's URDF in robot_description, or leave link "
         "empty and publish the object's twist on control_twist";
}

void HeldMotion::setGrasp(bool grasped, const std::string& link) {
  if (grasped && !grasped_) twists_.clear();  // what was commanded before did not move the object
  grasped_ = grasped;
  link_ = link;
  link_problem_ = grasped ? findLinkProblem(link) : "";
}

std::string HeldMotion::addTwist(const geometry_msgs::TwistStamped& twist, const std::string& camera_frame,
                                 const tf2::BufferCore& tf) {
  const std::string& given = twist.header.frame_id;
  const std::string frame = !given.empty() && given.front() == '/' ? given.substr(1) : given;
  TwistSample sample;
  sample.stamp_s = twist.header.stamp.toSec();
  sample.linear_m_s = {twist.twist.linear.x, twist.twist.linear.y, twist.twist.linear.z};
  sample.angular_rad_s = {twist.twist.angular.x, twist.twist.angular.y, twist.twist.angular.z};
  if (!frame.empty() && !camera_frame.empty() && frame != camera_frame) {
    try {
      const auto transform = tf.lookupTransform(camera_frame, frame, twist.header.stamp);
      const Eigen::Matrix3d R_camera_frame = fromTransformMessage(transform.transform).linear();
      sample.linear_m_s = (R_camera_frame * sample.linear_m_s).eval();
      sample.angular_rad_s = (R_camera_frame * sample.angular_rad_s).eval();
    } catch (const tf2::TransformException& error) {
      return "control_twist is ignored: tf cannot turn it from frame '" + frame + "' to the camera's frame '" +
             camera_frame + "': " + error.what();
    }
  }
  return twists_.add(sample) ? "" : "control_twist is ignored: it holds a number that is not finite";
}

bool HeldMotion::awaitsControl(double stamp_s, const std::string& camera_frame) const {
  if (followsLink()) return robot()->awaits(link_, camera_frame, stamp_s);
  const auto newest_s = twists_.newestStamp();
  return followsTwist() && newest_s && stamp_s > *newest_s && stamp_s - *newest_s < kLiveTwistAgeS;
}

HeldControl HeldMotion::control(double from_s, double to_s, const std::string& camera_frame,
                                const Pose& T_camera_object, const Pose& T_now_before) const {
  HeldControl held;
  if (!grasped_) return held;
  held.control.emplace();
  held.control->grasped = true;
  held.control->has_twist = false;
  if (followsLink()) {
    const HandControl hand = robot()->control(link_, camera_frame, from_s, to_s, T_camera_object, T_now_before);
    held.control = hand.control;
    held.problem = hand.problem;
  } else if (followsTwist()) {
    const auto mean = twists_.mean(from_s, to_s);
    held.control->has_twist = mean.has_value();
    if (!mean) held.problem = "control_twist says nothing about the time of the image; check the topic and its stamps";
    if (mean) held.control->linear_m_s = mean->linear_m_s;
    if (mean) held.control->angular_rad_s = mean->angular_rad_s;
  } else {
    held.problem = link_problem_;
  }
  return held;
}

void HeldMotion::forget() {
  twists_.clear();
  if (robot()) robot()->forget();
}

}  // namespace depth_object_tracker
