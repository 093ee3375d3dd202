// SPDX-License-Identifier: BSD-3-Clause
// Makes the camera known to nodelet managers.
#include "depth_object_tracker/ros/openni2_camera_nodelet.h"

#include <pluginlib/class_list_macros.hpp>

PLUGINLIB_EXPORT_CLASS(depth_object_tracker::OpenNI2CameraNodelet, nodelet::Nodelet)
