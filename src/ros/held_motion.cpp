// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/held_motion.h"

#include "depth_object_tracker/ros/message_conversions.h"

#include <tf2/exceptions.h>

namespace depth_object_tracker {
namespace {

constexpr double kLiveTwistAgeS = 0.2;  // a stream of twists that is older than this has ended

}  // namespace

void HeldMotion::setGrasp(bool grasped, const std::string& link) {
  if (grasped && !grasped_) twists_.clear();  // what was commanded before did not move the object
  grasped_ = grasped;
  link_ = link;
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

bool HeldMotion::awaitsTwist(double stamp_s) const {
  const auto newest_s = twists_.newestStamp();
  return followsTwist() && newest_s && *newest_s<stamp_s&& * newest_s> stamp_s - kLiveTwistAgeS;
}

std::optional<ControlInput> HeldMotion::control(double from_s, double to_s) const {
  if (!grasped_) return std::nullopt;
  ControlInput control;
  control.grasped = true;
  control.has_twist = false;
  const auto mean = link_.empty() ? twists_.mean(from_s, to_s) : std::nullopt;
  if (mean) {
    control.has_twist = true;
    control.linear_m_s = mean->linear_m_s;
    control.angular_rad_s = mean->angular_rad_s;
  }
  return control;
}

}  // namespace depth_object_tracker
