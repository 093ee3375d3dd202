// SPDX-License-Identifier: BSD-3-Clause
// Pictures and camera_info of grey (or colour) cameras for the fiducial tracker.
#pragma once

#include "depth_object_tracker/fiducials/fiducial_points.h"
#include "depth_object_tracker/fiducials/gray_image.h"

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <cstdint>
#include <string>
#include <vector>

namespace depth_object_tracker {

/// A mono8 message is viewed in place, rgb8, bgr8, rgba8 and bgra8 are converted.
class GrayImage {
 public:
  /// @param message must outlive the view when it is mono8.
  explicit GrayImage(const sensor_msgs::Image& message);

  const GrayImageView& view() const { return view_; }
  const std::string& problem() const { return problem_; }  ///< empty = usable; otherwise what is wrong and what to do

 private:
  void convert(const sensor_msgs::Image& message, std::size_t channels, bool blue_first);

  GrayImageView view_;
  std::vector<std::uint8_t> converted_;
  std::string problem_;
};

struct StereoCameraResult {
  StereoCamera camera;
  std::string problem;  ///< empty = usable
};

/// The rectified pair that two camera_info messages describe: the projection matrices P, the right one with -fx *
/// baseline in its fourth column (as camera_calibration and stereo_image_proc have it).
StereoCameraResult stereoCameraFromInfos(const sensor_msgs::CameraInfo& left, const sensor_msgs::CameraInfo& right,
                                         int image_width, int image_height);

}  // namespace depth_object_tracker
