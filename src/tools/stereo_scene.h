// SPDX-License-Identifier: BSD-3-Clause
// The grey stereo pictures of a scene folder.
#pragma once

#include "depth_object_tracker/fiducials/fiducial_points.h"
#include "depth_object_tracker/fiducials/gray_image.h"

#include <opencv2/core.hpp>

#include <string>

namespace depth_object_tracker {

/// stereo.json: {"cam_K": [9], "baseline_m": b, "left_in_camera_m": [3]}; the axes of the left camera are parallel to
/// the depth camera's.
struct StereoScene {
  std::string folder;
  StereoCamera camera;  ///< without the pictures' size
  Pose T_camera_left = Pose::Identity();
};

/// @throws InputError naming file, key and what is wrong.
StereoScene loadStereoScene(const std::string& folder);

struct StereoPictures {
  cv::Mat left, right;  ///< 8-bit grey
  bool isUsable() const { return !left.empty() && left.size() == right.size(); }
};

/// stereo/left/%06d.png and stereo/right/%06d.png; empty where there is none.
StereoPictures readStereoPictures(const StereoScene& scene, int frame);

GrayImageView viewOf(const cv::Mat& picture);

}  // namespace depth_object_tracker
