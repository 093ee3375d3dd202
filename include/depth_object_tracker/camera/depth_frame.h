// SPDX-License-Identifier: BSD-3-Clause
// One depth image as it lies in the driver's buffer, and what is needed to make a message of it.
#pragma once

#include <cstdint>
#include <vector>

namespace depth_object_tracker {

/// A view: `data` belongs to the driver and is valid only during the callback that hands the frame out.
struct DepthFrame {
  const std::uint16_t* data = nullptr;  ///< row-major, 0 = no reading, this machine's byte order
  int width = 0;                        ///< [px] of the image
  int height = 0;                       ///< [px]
  int stride_px = 0;                    ///< [px] from row to row
  int units_per_mm = 1;                 ///< 1: millimetres; 10: tenths of a millimetre
  bool is_mirrored = false;             ///< columns run from right to left, and the device cannot be told otherwise
  int full_width = 0;                   ///< [px] of the sensor's image, of which this one may be a part
  int full_height = 0;                  ///< [px]
  int column_offset = 0;                ///< [px] of the part in the sensor's image
  int row_offset = 0;                   ///< [px]
  double timestamp_s = 0.0;             ///< [s] of the device's own clock
  double horizontal_fov_rad = 0.0;      ///< of the sensor's image; <= 0: the device does not say
  bool is_registered = false;           ///< seen from the colour camera
};

/// 16UC1 pixels in millimetres, unmirrored, without padding.
/// @param bytes is resized to width * height * 2; its memory is reused.
void copyMillimetres(const DepthFrame& frame, std::vector<std::uint8_t>& bytes);

/// 32FC1 pixels in metres, NaN = no reading (REP-118), unmirrored, without padding.
void copyMetres(const DepthFrame& frame, std::vector<std::uint8_t>& bytes);

/// Focal length [px] of the sensor's image that its field of view gives, square pixels assumed.
/// A device that does not say has 57 degrees, as PrimeSense's.
double factoryFocalLengthPx(const DepthFrame& frame);

}  // namespace depth_object_tracker
