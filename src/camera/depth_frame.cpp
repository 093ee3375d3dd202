// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/camera/depth_frame.h"

#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>

namespace depth_object_tracker {
namespace {

constexpr double kPrimeSenseFovRad = 1.0144686707507438;  // horizontal, from PrimeSense's own driver
constexpr double kPi = 3.14159265358979323846;

/// Writes convert(pixel) for every pixel, left to right.
template <typename Value, typename Convert>
void convertPixels(const DepthFrame& frame, std::vector<std::uint8_t>& bytes, const Convert& convert) {
  bytes.resize(sizeof(Value) * static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height));
  std::uint8_t* out = bytes.data();
  for (int row = 0; row < frame.height; ++row) {
    const std::uint16_t* first = frame.data + static_cast<std::ptrdiff_t>(row) * frame.stride_px;
    for (int col = 0; col < frame.width; ++col, out += sizeof(Value)) {
      const Value value = convert(first[frame.is_mirrored ? frame.width - 1 - col : col]);
      std::memcpy(out, &value, sizeof(Value));  // nobody promises that the message's bytes are aligned
    }
  }
}

}  // namespace

void copyMillimetres(const DepthFrame& frame, std::vector<std::uint8_t>& bytes) {
  if (frame.units_per_mm == 1 && !frame.is_mirrored && frame.stride_px == frame.width) {
    const auto* first = reinterpret_cast<const std::uint8_t*>(frame.data);
    bytes.assign(first, first + 2 * static_cast<std::ptrdiff_t>(frame.width) * frame.height);
    return;
  }
  const int unit = frame.units_per_mm;
  convertPixels<std::uint16_t>(
      frame, bytes, [unit](std::uint16_t depth) { return static_cast<std::uint16_t>((depth + unit / 2) / unit); });
}

void copyMetres(const DepthFrame& frame, std::vector<std::uint8_t>& bytes) {
  const auto metres_per_unit = static_cast<float>(0.001 / frame.units_per_mm);
  convertPixels<float>(frame, bytes, [metres_per_unit](std::uint16_t depth) {
    return depth == 0 ? std::numeric_limits<float>::quiet_NaN() : metres_per_unit * static_cast<float>(depth);
  });
}

double factoryFocalLengthPx(const DepthFrame& frame) {
  const bool is_known = frame.horizontal_fov_rad > 0.0 && frame.horizontal_fov_rad < kPi;
  const double fov_rad = is_known ? frame.horizontal_fov_rad : kPrimeSenseFovRad;
  return 0.5 * frame.full_width / std::tan(0.5 * fov_rad);
}

}  // namespace depth_object_tracker
