// SPDX-License-Identifier: BSD-3-Clause
// sensor_msgs/CameraInfo as the pinhole camera of the image that came with it.
#pragma once

#include "depth_object_tracker/geometry/pinhole_camera.h"

#include <sensor_msgs/CameraInfo.h>

#include <string>

namespace depth_object_tracker {

/// Which of CameraInfo's matrices describes the image.
enum class Intrinsics {
  kRaw,        ///< K
  kRectified,  ///< P
};

/// kRectified when the topic's last name contains "rect" (image_rect, image_rect_raw), as image_proc names them.
Intrinsics intrinsicsForTopic(const std::string& image_topic);

struct CameraResult {
  PinholeCamera camera;
  std::string problem;  ///< empty = usable; otherwise what is wrong with the message and what to do
};

/// Camera of an image of the given size: CameraInfo describes the full resolution, from which region of interest and
/// binning lead to the image. An image_proc/resize style message (K and P already scaled, no binning) comes out the
/// same way.
CameraResult cameraFromInfo(const sensor_msgs::CameraInfo& info, Intrinsics intrinsics, int image_width,
                            int image_height);

/// True when a distortion coefficient is not zero: a raw image is then not exactly a pinhole picture.
bool hasDistortion(const sensor_msgs::CameraInfo& info);

}  // namespace depth_object_tracker
