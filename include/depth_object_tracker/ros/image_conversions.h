// SPDX-License-Identifier: BSD-3-Clause
// sensor_msgs/Image as a depth image view, in place.
#pragma once

#include "depth_object_tracker/geometry/depth_image.h"

#include <sensor_msgs/Image.h>

#include <string>

namespace depth_object_tracker {

struct ImageViewResult {
  DepthImageView view;  ///< points into the message
  std::string problem;  ///< empty = usable; otherwise what is wrong with the message and what to do
};

/// Views a 16UC1 or mono16 (millimetres) or 32FC1 (metres) image without a copy; honours step and is_bigendian.
/// Nothing in the message is trusted: sizes are checked against the data that really came.
/// @param image must outlive the view.
ImageViewResult viewDepthImage(const sensor_msgs::Image& image);

}  // namespace depth_object_tracker
