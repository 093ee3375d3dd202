// SPDX-License-Identifier: BSD-3-Clause
// The ROS parameters of the fiducial tracker.
#pragma once

#include "depth_object_tracker/fiducials/fiducial_tracker.h"

#include <ros/node_handle.h>

#include <string>
#include <vector>

namespace depth_object_tracker {

enum class FiducialInput {
  kStereo,  ///< a rectified pair
  kRgbd,    ///< one camera with registered depth
};

/// @throws std::invalid_argument naming the word and the allowed ones.
FiducialInput fiducialInputFromName(const std::string& name);

struct FiducialOptions {
  std::string object_name = "object";  ///< tf's child frame is <object_name>_fiducials
  std::string fiducials_file;          ///< `package://`, `file://` or a plain path
  FiducialInput input = FiducialInput::kStereo;
  bool publish_tf = true;
  FiducialTrackerConfig tracker;
  std::vector<std::string> problems;  ///< one sentence each, naming parameter, value and range; empty = all good
};

/// Reads `object_name, fiducials_file, input, publish_tf, lost_after_s, corner_stddev_px, depth_stddev_m,
/// max_row_difference_px, max_rms_m, num_threads`.
FiducialOptions loadFiducialOptions(const ros::NodeHandle& private_node);

}  // namespace depth_object_tracker
