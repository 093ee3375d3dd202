// SPDX-License-Identifier: BSD-3-Clause
// Decodes 16-bit depth PNGs.
#include "depth_object_tracker/tools/depth_picture.h"

#include "depth_object_tracker/tools/input_error.h"

#include <opencv2/imgcodecs.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>

namespace depth_object_tracker {

DepthImageView DepthPicture::view(double unit_m) const {
  DepthImageView view;
  view.data = reinterpret_cast<const std::uint8_t*>(counts.data());
  view.width = width;
  view.height = height;
  view.step = sizeof(std::uint16_t) * static_cast<std::size_t>(width);
  view.pixel_type = DepthImageView::PixelType::kUint16;
  view.unit_m = static_cast<float>(unit_m);
  return view;
}

namespace {

constexpr std::uint32_t kMaxPixels = 1u << 26;  // 8192 x 8192

/// A header may promise gigabytes that are not there: the decoder would make room for them first.
void checkPromisedSize(const std::string& path) {
  constexpr std::size_t kHeaderBytes = 24;  // signature, length and name of the first chunk, width, height
  std::array<unsigned char, kHeaderBytes> header{};
  std::ifstream file(path, std::ios::binary);
  if (!file.read(reinterpret_cast<char*>(header.data()), kHeaderBytes) || header[1] != 'P')
    return;  // told by the decoder
  const auto word = [&header](std::size_t at) {
    return std::uint64_t{header[at]} << 24 | std::uint64_t{header[at + 1]} << 16 | std::uint64_t{header[at + 2]} << 8 |
           header[at + 3];
  };
  if (word(16) * word(20) <= kMaxPixels) return;
  throw InputError(path + " promises " + std::to_string(word(16)) + "x" + std::to_string(word(20)) +
                   " pixels, more than are accepted");
}

}  // namespace

DepthPicture readDepthPicture(const std::string& path) {
  if (!std::filesystem::exists(path)) throw InputError("there is no picture " + path);
  checkPromisedSize(path);
  cv::Mat decoded;
  try {
    decoded = cv::imread(path, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception& error) {
    throw InputError("cannot decode " + path + ": " + error.err);
  }
  if (decoded.empty()) throw InputError("cannot decode " + path + ": truncated or not a PNG picture");
  if (decoded.type() != CV_16UC1) {
    throw InputError(path + " has " + std::to_string(decoded.channels()) + " channel(s) of " +
                     std::to_string(8 * decoded.elemSize1()) + " bits; depth needs one channel of 16 bits");
  }
  DepthPicture picture = emptyDepthPicture(decoded.cols, decoded.rows);
  for (int row = 0; row < decoded.rows; ++row) {
    const std::uint16_t* begin = decoded.ptr<std::uint16_t>(row);
    std::copy(begin, begin + decoded.cols, picture.counts.begin() + static_cast<std::ptrdiff_t>(row) * decoded.cols);
  }
  return picture;
}

DepthPicture emptyDepthPicture(int width, int height) {
  DepthPicture picture;
  picture.width = width;
  picture.height = height;
  picture.counts.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
  return picture;
}

}  // namespace depth_object_tracker
