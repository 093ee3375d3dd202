// SPDX-License-Identifier: BSD-3-Clause
// Depth images and camera_info whose fields lie about each other: every pixel that the view offers must be there.
#include "depth_object_tracker/ros/camera_conversions.h"
#include "depth_object_tracker/ros/image_conversions.h"
#include "fuzz_input.h"

#include <memory>

namespace dot = depth_object_tracker;

namespace {

/// Small numbers, so that fields often fit each other, and now and then any number.
std::uint32_t size(FuzzedDataProvider& input) {
  return input.ConsumeIntegralInRange(0, 15) == 0 ? input.ConsumeIntegral<std::uint32_t>()
                                                  : input.ConsumeIntegralInRange<std::uint32_t>(0, 40);
}

double number(FuzzedDataProvider& input) {
  return input.ConsumeBool() ? input.ConsumeFloatingPointInRange(-100.0, 1000.0) : input.ConsumeFloatingPoint<double>();
}

sensor_msgs::CameraInfo makeInfo(FuzzedDataProvider& input) {
  sensor_msgs::CameraInfo info;
  info.width = size(input);
  info.height = size(input);
  for (const int k : {0, 4, 2, 5}) info.K[static_cast<std::size_t>(k)] = number(input);
  if (input.ConsumeBool()) {
    for (const int k : {0, 5, 2, 6}) info.P[static_cast<std::size_t>(k)] = number(input);
  }
  for (int k = input.ConsumeIntegralInRange(0, 8); k > 0; --k) info.D.push_back(number(input));
  if (input.ConsumeBool()) {
    info.binning_x = size(input);
    info.binning_y = size(input);
    info.roi.x_offset = size(input);
    info.roi.y_offset = size(input);
    info.roi.width = size(input);
    info.roi.height = size(input);
  }
  return info;
}

sensor_msgs::Image makeImage(FuzzedDataProvider& input) {
  sensor_msgs::Image image;
  image.encoding = input.PickValueInArray({"16UC1", "32FC1", "mono16", "8UC3", "32FC2", ""});
  if (input.ConsumeIntegralInRange(0, 31) == 0) image.encoding = input.ConsumeRandomLengthString(20);
  image.is_bigendian = input.ConsumeIntegral<std::uint8_t>();
  image.width = size(input);
  image.height = size(input);
  image.step = input.ConsumeBool() ? image.width * (image.encoding == "32FC1" ? 4 : 2) : size(input);
  const std::uint64_t fitting = std::uint64_t{image.step} * image.height;
  const bool fits = input.ConsumeBool() && fitting < 100000;
  std::vector<std::uint8_t> data = input.ConsumeRemainingBytes<std::uint8_t>();
  if (fits) data.resize(fitting);
  data.shrink_to_fit();  // one byte behind the end is an error
  image.data = std::move(data);
  return image;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size_bytes) {
  FuzzedDataProvider input(data, size_bytes);
  const std::string topic = input.ConsumeBool() ? "camera/depth/image_rect" : input.ConsumeRandomLengthString(12);
  const sensor_msgs::CameraInfo info = makeInfo(input);
  const sensor_msgs::Image image = makeImage(input);

  const dot::ImageViewResult result = dot::viewDepthImage(image);
  float sum = 0.0f;
  if (result.problem.empty()) {
    for (int row = 0; row < result.view.height; ++row) {
      for (int col = 0; col < result.view.width; ++col) sum += result.view.at(row, col);
    }
  }
  volatile float keep = sum;
  static_cast<void>(keep);

  const int width = static_cast<int>(image.width & 0xffff), height = static_cast<int>(image.height & 0xffff);
  const dot::CameraResult camera = dot::cameraFromInfo(info, dot::intrinsicsForTopic(topic), width, height);
  if (camera.problem.empty() && !camera.camera.findProblem().empty()) __builtin_trap();
  dot::hasDistortion(info);
  return 0;
}
