// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/gray_conversions.h"

#include "depth_object_tracker/ros/camera_conversions.h"

#include <sensor_msgs/image_encodings.h>

#include <cmath>
#include <map>
#include <sstream>

namespace depth_object_tracker {
namespace {

struct Layout {
  std::size_t channels;
  bool blue_first;
};

const std::map<std::string, Layout>& layouts() {
  namespace enc = sensor_msgs::image_encodings;
  static const std::map<std::string, Layout> all{{enc::MONO8, {1, false}}, {enc::TYPE_8UC1, {1, false}},
                                                 {enc::RGB8, {3, false}},  {enc::BGR8, {3, true}},
                                                 {enc::RGBA8, {4, false}}, {enc::BGRA8, {4, true}}};
  return all;
}

}  // namespace

GrayImage::GrayImage(const sensor_msgs::Image& message) {
  const auto layout = layouts().find(message.encoding);
  if (layout == layouts().end()) {
    problem_ = "the image's encoding is '" + message.encoding +
               "'; mono8, rgb8, bgr8, rgba8 or bgra8 is needed: rectify with image_proc, which also debayers";
    return;
  }
  const std::size_t row_bytes = layout->second.channels * message.width;
  if (message.width == 0 || message.height == 0 || message.step < row_bytes ||
      message.data.size() < std::size_t{message.step} * message.height) {
    std::ostringstream problem;
    problem << "the image's header promises " << message.width << "x" << message.height << " pixels, step "
            << message.step << ", but it carries " << message.data.size()
            << " bytes: the driver or the transport is broken, check it";
    problem_ = problem.str();
    return;
  }
  view_ = {message.data.data(), static_cast<int>(message.width), static_cast<int>(message.height), message.step};
  if (layout->second.channels > 1) convert(message, layout->second.channels, layout->second.blue_first);
}

void GrayImage::convert(const sensor_msgs::Image& message, std::size_t channels, bool blue_first) {
  converted_.resize(std::size_t{message.width} * message.height);
  std::uint8_t* gray = converted_.data();
  for (std::uint32_t row = 0; row < message.height; ++row) {
    const std::uint8_t* pixel = message.data.data() + std::size_t{row} * message.step;
    for (std::uint32_t col = 0; col < message.width; ++col, pixel += channels) {
      const int red = pixel[blue_first ? 2 : 0], blue = pixel[blue_first ? 0 : 2];
      *gray++ = static_cast<std::uint8_t>((77 * red + 150 * pixel[1] + 29 * blue) / 256);  // ITU-R BT.601
    }
  }
  view_ = {converted_.data(), static_cast<int>(message.width), static_cast<int>(message.height), message.width};
}

StereoCameraResult stereoCameraFromInfos(const sensor_msgs::CameraInfo& left, const sensor_msgs::CameraInfo& right,
                                         int image_width, int image_height) {
  StereoCameraResult result;
  const CameraResult camera = cameraFromInfo(left, Intrinsics::kRectified, image_width, image_height);
  result.problem = camera.problem;
  if (!result.problem.empty()) return result;
  result.camera.left = camera.camera;
  result.camera.baseline_m = right.P[0] != 0.0 ? -right.P[3] / right.P[0] : 0.0;
  if (!(result.camera.baseline_m > 0.0) || !std::isfinite(result.camera.baseline_m)) {
    result.problem =
        "the right camera_info's P tells no baseline (P[3] = -fx * baseline): calibrate the pair as a stereo camera, "
        "and check "
        "that left and right are not exchanged";
  }
  return result;
}

}  // namespace depth_object_tracker
