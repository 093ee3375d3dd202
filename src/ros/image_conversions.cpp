// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/image_conversions.h"

#include <sensor_msgs/image_encodings.h>

#include <optional>
#include <sstream>

namespace depth_object_tracker {
namespace {

constexpr std::uint32_t kMaxImageSide = 32768;

std::optional<DepthImageView::PixelType> pixelType(const std::string& encoding) {
  namespace enc = sensor_msgs::image_encodings;
  if (encoding == enc::TYPE_16UC1 || encoding == enc::MONO16) return DepthImageView::PixelType::kUint16;
  if (encoding == enc::TYPE_32FC1) return DepthImageView::PixelType::kFloat32;
  return std::nullopt;
}

std::string findSizeProblem(const sensor_msgs::Image& image, std::size_t pixel_bytes) {
  std::ostringstream problem;
  const std::size_t row_bytes = std::size_t{image.width} * pixel_bytes;
  const std::size_t promised_bytes = std::size_t{image.step} * image.height;
  if (image.width == 0 || image.height == 0 || image.width > kMaxImageSide || image.height > kMaxImageSide) {
    problem << "the image's header gives its size as " << image.width << "x" << image.height
            << "; each side must be in [1, " << kMaxImageSide << "]";
  } else if (image.step < row_bytes) {
    problem << "the image's header gives step=" << image.step << " bytes, but a row of " << image.width << " pixels in "
            << image.encoding << " takes " << row_bytes;
  } else if (image.data.size() < promised_bytes) {
    problem << "the image carries " << image.data.size() << " bytes, but its header promises " << promised_bytes
            << " (height " << image.height << " * step " << image.step << ")";
  }
  return problem.str();
}

bool machineIsBigEndian() {
  const std::uint16_t one = 1;
  std::uint8_t first_byte;
  std::memcpy(&first_byte, &one, 1);
  return first_byte == 0;
}

}  // namespace

ImageViewResult viewDepthImage(const sensor_msgs::Image& image) {
  ImageViewResult result;
  const auto type = pixelType(image.encoding);
  if (!type) {
    result.problem =
        "the image's encoding is '" + image.encoding +
        "'; a depth image must be 16UC1 or mono16 (millimetres) or 32FC1 (metres): is this the depth topic?";
    return result;
  }
  const bool is_uint16 = *type == DepthImageView::PixelType::kUint16;
  result.problem = findSizeProblem(image, is_uint16 ? 2 : 4);
  if (!result.problem.empty()) {
    result.problem += ": the driver or the transport is broken, check it";
    return result;
  }
  result.view.data = image.data.data();
  result.view.width = static_cast<int>(image.width);
  result.view.height = static_cast<int>(image.height);
  result.view.step = image.step;
  result.view.pixel_type = *type;
  result.view.swap_bytes = (image.is_bigendian != 0) != machineIsBigEndian();
  result.view.unit_m = is_uint16 ? 0.001f : 1.0f;
  return result;
}

}  // namespace depth_object_tracker
