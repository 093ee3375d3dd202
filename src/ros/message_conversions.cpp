// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/message_conversions.h"

#include <boost/array.hpp>

namespace depth_object_tracker {
namespace {

geometry_msgs::Quaternion toQuaternionMessage(const Eigen::Matrix3d& rotation) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(rotation).normalized();
  geometry_msgs::Quaternion message;
  message.x = q.x();
  message.y = q.y();
  message.z = q.z();
  message.w = q.w();
  return message;
}

void fillCovariance(const Matrix6d& covariance, boost::array<double, 36>& message) {
  for (int i = 0; i < 36; ++i) message[static_cast<std::size_t>(i)] = covariance(i / 6, i % 6);
}

geometry_msgs::Vector3 toVectorMessage(const Eigen::Vector3d& v) {
  geometry_msgs::Vector3 message;
  message.x = v.x();
  message.y = v.y();
  message.z = v.z();
  return message;
}

}  // namespace

geometry_msgs::Pose toPoseMessage(const Pose& pose) {
  geometry_msgs::Pose message;
  message.position.x = pose.translation().x();
  message.position.y = pose.translation().y();
  message.position.z = pose.translation().z();
  message.orientation = toQuaternionMessage(pose.linear());
  return message;
}

geometry_msgs::Transform toTransformMessage(const Pose& pose) {
  geometry_msgs::Transform message;
  message.translation = toVectorMessage(pose.translation());
  message.rotation = toQuaternionMessage(pose.linear());
  return message;
}

Pose fromTransformMessage(const geometry_msgs::Transform& transform) {
  const auto& t = transform.translation;
  const auto& q = transform.rotation;
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(t.x, t.y, t.z);
  pose.linear() = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
  return pose;
}

geometry_msgs::PoseWithCovariance toPoseMessage(const Pose& pose, const Matrix6d& covariance) {
  geometry_msgs::PoseWithCovariance message;
  message.pose = toPoseMessage(pose);
  fillCovariance(covariance, message.covariance);
  return message;
}

geometry_msgs::TwistWithCovariance toTwistMessage(const Vector6d& twist, const Matrix6d& covariance) {
  geometry_msgs::TwistWithCovariance message;
  message.twist.linear = toVectorMessage(twist.head<3>());
  message.twist.angular = toVectorMessage(twist.tail<3>());
  fillCovariance(covariance, message.covariance);
  return message;
}

}  // namespace depth_object_tracker
