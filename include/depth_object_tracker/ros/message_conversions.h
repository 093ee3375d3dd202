// SPDX-License-Identifier: BSD-3-Clause
// Geometry of the core as ROS messages.
#pragma once

#include "depth_object_tracker/geometry/pose.h"

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/PoseWithCovariance.h>
#include <geometry_msgs/Transform.h>
#include <geometry_msgs/TwistWithCovariance.h>

namespace depth_object_tracker {

geometry_msgs::Pose toPoseMessage(const Pose& pose);
geometry_msgs::Transform toTransformMessage(const Pose& pose);
Pose fromTransformMessage(const geometry_msgs::Transform& transform);
geometry_msgs::PoseWithCovariance toPoseMessage(const Pose& pose, const Matrix6d& covariance);
geometry_msgs::TwistWithCovariance toTwistMessage(const Vector6d& twist, const Matrix6d& covariance);

}  // namespace depth_object_tracker
