// SPDX-License-Identifier: BSD-3-Clause
// The shipped arm, swinging, with the test object in its hand before the test camera.
#pragma once

#include "depth_messages.h"
#include "depth_object_tracker/robot/robot_model.h"
#include "depth_object_tracker/ros/message_conversions.h"

#include <geometry_msgs/TransformStamped.h>
#include <sensor_msgs/JointState.h>

#include <cmath>
#include <string>

namespace depth_object_tracker {

inline std::string armFile() {
  return std::string(PROJECT_SOURCE_FOLDER) + "/config/robots/arm.urdf";
}

/// Chosen so that the object stands at testPose() when the swing begins; the camera looks at the arm from nowhere
/// special.
class SwingingArm {
 public:
  explicit SwingingArm(double begin_s)
      : begin_s_(begin_s),
        chain_(RobotModel::fromFile(armFile()).chainTo("hand_link")),
        T_hand_object_(Pose(Eigen::Translation3d(0.02, -0.01, 0.12)) *
                       Pose(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()))),
        T_camera_base_(testPose() * T_hand_object_.inverse() * T_base_hand(begin_s).inverse()) {}

  static double angle(int joint, double t_s) { return 0.2 * joint - 0.5 + 0.15 * std::sin((1.0 + 0.2 * joint) * t_s); }
  static double rate(int joint, double t_s) { return 0.15 * (1.0 + 0.2 * joint) * std::cos((1.0 + 0.2 * joint) * t_s); }

  Pose T_base_hand(double stamp_s) const {
    Eigen::VectorXd positions(7);
    for (int joint = 1; joint <= 7; ++joint) positions[joint - 1] = angle(joint, stamp_s - begin_s_);
    return chain_.pose(positions);
  }
  const Pose& T_camera_base() const { return T_camera_base_; }
  Pose T_camera_hand(double stamp_s) const { return T_camera_base_ * T_base_hand(stamp_s); }
  Pose T_camera_object(double stamp_s) const { return T_camera_hand(stamp_s) * T_hand_object_; }
  const Pose& T_hand_object() const { return T_hand_object_; }

  /// As a robot's driver publishes it, with a gripper joint too.
  sensor_msgs::JointState jointStates(double stamp_s) const {
    sensor_msgs::JointState message;
    message.header.stamp = ros::Time(stamp_s);
    for (int joint = 7; joint >= 1; --joint) {
      message.name.push_back("joint_" + std::to_string(joint));
      message.position.push_back(angle(joint, stamp_s - begin_s_));
      message.velocity.push_back(rate(joint, stamp_s - begin_s_));
    }
    return message;
  }

  geometry_msgs::TransformStamped cameraTransform(
      const std::string& camera_frame = "camera_depth_optical_frame") const {
    geometry_msgs::TransformStamped transform;
    transform.header.frame_id = "base_link";
    transform.child_frame_id = camera_frame;
    transform.transform = toTransformMessage(T_camera_base_.inverse());
    return transform;
  }

 private:
  double begin_s_;
  LinkChain chain_;
  Pose T_hand_object_, T_camera_base_;
};

}  // namespace depth_object_tracker
