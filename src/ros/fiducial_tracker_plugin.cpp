// SPDX-License-Identifier: BSD-3-Clause
// Makes the fiducial tracker known to nodelet managers.
#include "depth_object_tracker/ros/fiducial_tracker_nodelet.h"

#include <pluginlib/class_list_macros.hpp>

PLUGINLIB_EXPORT_CLASS(depth_object_tracker::FiducialTrackerNodelet, nodelet::Nodelet)
