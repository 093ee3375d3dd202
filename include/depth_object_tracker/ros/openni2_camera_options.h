// SPDX-License-Identifier: BSD-3-Clause
// The ROS parameters of the OpenNI2 camera nodelet.
#pragma once

#include "depth_object_tracker/camera/depth_camera_options.h"

#include <ros/node_handle.h>

#include <string>
#include <vector>

namespace depth_object_tracker {

struct OpenNI2CameraOptions {
  DepthCameraOptions camera;
  std::string camera_name;      ///< of the calibration; empty = "depth_" and the serial number
  std::string camera_info_url;  ///< empty = file://${ROS_HOME}/camera_info/NAME.yaml
  std::string depth_frame_id = "camera_depth_optical_frame";
  std::string rgb_frame_id = "camera_rgb_optical_frame";  ///< of registered images
  std::string parent_frame_id;  ///< static tf from here to the images' frame, optical axes turned only; empty = none
  double time_offset_s = 0.0;   ///< added to every stamp
  std::vector<std::string> problems;  ///< one sentence each, naming parameter, value and valid range; empty = all good
};

OpenNI2CameraOptions loadOpenNI2CameraOptions(const ros::NodeHandle& private_node);

}  // namespace depth_object_tracker
