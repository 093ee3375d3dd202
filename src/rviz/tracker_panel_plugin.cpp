// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/rviz/tracker_panel.h"

#include <pluginlib/class_list_macros.hpp>

PLUGINLIB_EXPORT_CLASS(depth_object_tracker::TrackerPanel, rviz::Panel)
