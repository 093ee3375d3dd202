// SPDX-License-Identifier: BSD-3-Clause
// A result as the messages that tell the object's pose.
#pragma once

#include "depth_object_tracker/tracker/tracker_result.h"

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/TwistWithCovarianceStamped.h>
#include <std_msgs/Header.h>

#include <string>

namespace depth_object_tracker {

/// False while LOST or UNINITIALIZED, and where a number is not finite.
bool hasPoseToTell(const TrackerResult& result);
bool hasTwistToTell(const TrackerResult& result);

/// The result is told in the header's frame.
geometry_msgs::PoseWithCovarianceStamped toPoseStamped(const TrackerResult& result, const std_msgs::Header& header);
geometry_msgs::TwistWithCovarianceStamped toTwistStamped(const TrackerResult& result, const std_msgs::Header& header);
geometry_msgs::TransformStamped toTransformStamped(const TrackerResult& result, const std_msgs::Header& header,
                                                   const std::string& child_frame);

}  // namespace depth_object_tracker
