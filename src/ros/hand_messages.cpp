// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/hand_messages.h"

#include "depth_object_tracker/ros/message_conversions.h"

namespace depth_object_tracker {
namespace {

Matrix6d turned(const Matrix6d& covariance, const Eigen::Matrix3d& R) {
  Matrix6d rotation = Matrix6d::Zero();
  rotation.topLeftCorner<3, 3>() = rotation.bottomRightCorner<3, 3>() = R;
  return rotation * covariance * rotation.transpose();
}

void write(const Eigen::Vector3d& vector, geometry_msgs::Vector3& message) {
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
}

}  // namespace

Slip toSlipMessage(const HandReport& report, const ros::Time& stamp, const std::string& camera_frame) {
  Slip message;
  message.header.stamp = stamp;
  message.header.frame_id = report.link.empty() ? camera_frame : report.link;
  message.hand_object.pose.orientation.w = 1.0;
  Eigen::Matrix3d R_link_camera = Eigen::Matrix3d::Identity();
  if (!report.link.empty()) {
    R_link_camera = (report.T_camera_link * report.observed.T_link_observed).linear().transpose();
    message.hand_object = toPoseMessage(report.observed.T_link_object, turned(report.covariance, R_link_camera));
  }
  write(R_link_camera * report.slip.relative_twist.head<3>(), message.relative_twist.linear);
  write(R_link_camera * report.slip.relative_twist.tail<3>(), message.relative_twist.angular);
  message.slipping = report.slip.slipping;
  return message;
}

geometry_msgs::PoseWithCovarianceStamped toCorrectionMessage(const HandReport& report, const ros::Time& stamp) {
  geometry_msgs::PoseWithCovarianceStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = report.link;
  // As sure as the object's pose: an error of its angle moves the hand by its distance.
  const Pose T_camera_observed = report.T_camera_link * report.observed.T_link_observed;
  const Matrix6d at_hand =
      transportCovariance(report.covariance, T_camera_observed.translation() - report.T_camera_object.translation());
  message.pose =
      toPoseMessage(report.observed.T_link_observed, turned(at_hand, report.T_camera_link.linear().transpose()));
  return message;
}

geometry_msgs::TransformStamped toCorrectionTransform(const HandReport& report, const ros::Time& stamp) {
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = stamp;
  transform.header.frame_id = report.link;
  transform.child_frame_id = report.link + "_observed";
  transform.transform = toTransformMessage(report.observed.T_link_observed);
  return transform;
}

}  // namespace depth_object_tracker
