// SPDX-License-Identifier: BSD-3-Clause
// What the tracker has to say about the hand that holds the object, and its messages.
#pragma once

#include "depth_object_tracker/model/slip_estimator.h"
#include "depth_object_tracker/robot/kinematic_correction.h"

#include <depth_object_tracker/Slip.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TransformStamped.h>

#include <string>

namespace depth_object_tracker {

struct HandReport {
  std::string link;                         ///< empty: held, but by no link that is known (control_twist)
  SlipEstimate slip;                        ///< camera axes
  Pose T_camera_link = Pose::Identity();    ///< by the kinematics
  Pose T_camera_object = Pose::Identity();  ///< as seen
  Matrix6d covariance = Matrix6d::Zero();   ///< of the object's pose, camera axes
  ObservedHand observed;
};

/// Frame: the link as observed; without a link the twist has the camera's axes and the pose is left out.
Slip toSlipMessage(const HandReport& report, const ros::Time& stamp, const std::string& camera_frame);

/// Frame: the link as the kinematics have it; the pose is that of the observed link in it.
geometry_msgs::PoseWithCovarianceStamped toCorrectionMessage(const HandReport& report, const ros::Time& stamp);

/// From the link to `<link>_observed`.
geometry_msgs::TransformStamped toCorrectionTransform(const HandReport& report, const ros::Time& stamp);

}  // namespace depth_object_tracker
