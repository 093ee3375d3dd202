// SPDX-License-Identifier: BSD-3-Clause
// Non-owning view of a depth image as a camera driver wrote it: no copy, no conversion of the whole picture.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

namespace depth_object_tracker {

/// View of depth pixels; the memory behind `data` must outlive it. Depth is along the optical axis (REP-118).
struct DepthImageView {
  enum class PixelType { kUint16, kFloat32 };

  const std::uint8_t* data = nullptr;
  int width = 0;
  int height = 0;
  std::size_t step = 0;  ///< bytes from one row to the next, >= width * pixel size
  PixelType pixel_type = PixelType::kUint16;
  bool swap_bytes = false;  ///< pixels are of the other endianness than this machine
  float unit_m = 0.001f;    ///< metres per count (kUint16) or per unit (kFloat32: 1)

  /// Depth in metres, NaN where there is no reading (0, NaN, Inf, negative). No bounds check.
  float at(int row, int col) const {
    const std::uint8_t* row_data = data + static_cast<std::size_t>(row) * step;
    return pixel_type == PixelType::kUint16 ? fromUint16(row_data, col) : fromFloat32(row_data, col);
  }

 private:
  float fromUint16(const std::uint8_t* row_data, int col) const {
    std::uint16_t count;
    std::memcpy(&count, row_data + 2 * static_cast<std::size_t>(col), sizeof(count));
    if (swap_bytes) count = static_cast<std::uint16_t>((count >> 8) | (count << 8));
    return count == 0 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(count) * unit_m;
  }

  float fromFloat32(const std::uint8_t* row_data, int col) const {
    std::uint32_t bits;
    std::memcpy(&bits, row_data + 4 * static_cast<std::size_t>(col), sizeof(bits));
    if (swap_bytes) bits = __builtin_bswap32(bits);
    float value;
    std::memcpy(&value, &bits, sizeof(value));
    return std::isfinite(value) && value > 0.0f ? value * unit_m : std::numeric_limits<float>::quiet_NaN();
  }
};

}  // namespace depth_object_tracker
