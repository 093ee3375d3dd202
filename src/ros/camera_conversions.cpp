// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/camera_conversions.h"

#include <algorithm>
#include <cstdint>
#include <sstream>

namespace depth_object_tracker {
namespace {

/// The part of the full-resolution picture that was read out, and how many of its pixels make one of the image.
struct Readout {
  std::int64_t x = 0, y = 0, width = 0, height = 0;
  std::int64_t binning_x = 1, binning_y = 1;
  bool is_full = true;
};

Readout readoutOf(const sensor_msgs::CameraInfo& info) {
  Readout readout;
  readout.binning_x = std::max<std::int64_t>(1, info.binning_x);
  readout.binning_y = std::max<std::int64_t>(1, info.binning_y);
  readout.is_full = info.roi.width == 0 || info.roi.height == 0;  // REP-104: all zero = full resolution
  readout.width = readout.is_full ? info.width : info.roi.width;
  readout.height = readout.is_full ? info.height : info.roi.height;
  readout.x = readout.is_full ? 0 : info.roi.x_offset;
  readout.y = readout.is_full ? 0 : info.roi.y_offset;
  return readout;
}

/// Cameras differ in what they do with the pixels left over by binning.
bool sizeFits(int image_size, std::int64_t readout_size, std::int64_t binning) {
  return image_size == readout_size / binning || image_size == (readout_size + binning - 1) / binning;
}

std::string findReadoutProblem(const sensor_msgs::CameraInfo& info, const Readout& readout, int width, int height) {
  std::ostringstream problem;
  if (readout.x + readout.width > info.width || readout.y + readout.height > info.height) {
    problem << "camera_info's roi (offset " << readout.x << ", " << readout.y << ", size " << readout.width << "x"
            << readout.height << ") reaches beyond its full size " << info.width << "x" << info.height;
  } else if (!sizeFits(width, readout.width, readout.binning_x) ||
             !sizeFits(height, readout.height, readout.binning_y)) {
    problem << "the image is " << width << "x" << height << ", but camera_info describes "
            << readout.width / readout.binning_x << "x" << readout.height / readout.binning_y << " (full size "
            << info.width << "x" << info.height << (readout.is_full ? "" : ", roi") << ", binning " << readout.binning_x
            << "x" << readout.binning_y << "): both must come from the same camera and mode";
  }
  return problem.str();
}

PinholeCamera fullCamera(const sensor_msgs::CameraInfo& info, Intrinsics intrinsics) {
  PinholeCamera camera;
  // Many drivers of rectified images leave P empty; without distortion K says the same.
  const bool use_p = intrinsics == Intrinsics::kRectified && !(info.P[0] == 0.0 && !hasDistortion(info));
  camera.fx = use_p ? info.P[0] : info.K[0];
  camera.fy = use_p ? info.P[5] : info.K[4];
  camera.cx = use_p ? info.P[2] : info.K[2];
  camera.cy = use_p ? info.P[6] : info.K[5];
  return camera;
}

}  // namespace

Intrinsics intrinsicsForTopic(const std::string& image_topic) {
  const std::string last_name = image_topic.substr(image_topic.rfind('/') + 1);
  return last_name.find("rect") != std::string::npos ? Intrinsics::kRectified : Intrinsics::kRaw;
}

CameraResult cameraFromInfo(const sensor_msgs::CameraInfo& info, Intrinsics intrinsics, int image_width,
                            int image_height) {
  CameraResult result;
  const Readout readout = readoutOf(info);
  result.problem = findReadoutProblem(info, readout, image_width, image_height);
  if (!result.problem.empty()) return result;

  const PinholeCamera full = fullCamera(info, intrinsics);
  result.camera.width = image_width;
  result.camera.height = image_height;
  result.camera.fx = full.fx / static_cast<double>(readout.binning_x);
  result.camera.fy = full.fy / static_cast<double>(readout.binning_y);
  result.camera.cx = (full.cx - static_cast<double>(readout.x)) / static_cast<double>(readout.binning_x);
  result.camera.cy = (full.cy - static_cast<double>(readout.y)) / static_cast<double>(readout.binning_y);
  result.problem = result.camera.findProblem();
  if (!result.problem.empty()) {
    result.problem = std::string("camera_info's ") + (intrinsics == Intrinsics::kRaw ? "K" : "P") +
                     " is not usable: " + result.problem;
  }
  return result;
}

bool hasDistortion(const sensor_msgs::CameraInfo& info) {
  return std::any_of(info.D.begin(), info.D.end(), [](double d) { return d != 0.0; });
}

}  // namespace depth_object_tracker
