// SPDX-License-Identifier: BSD-3-Clause
// Makes the simulator known to nodelet managers.
#include "depth_object_tracker/ros/simulator_nodelet.h"

#include <pluginlib/class_list_macros.hpp>

PLUGINLIB_EXPORT_CLASS(depth_object_tracker::SimulatorNodelet, nodelet::Nodelet)
