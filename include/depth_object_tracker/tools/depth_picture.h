// SPDX-License-Identifier: BSD-3-Clause
// Decodes 16-bit depth PNGs.
#pragma once

#include "depth_object_tracker/geometry/depth_image.h"

#include <cstdint>
#include <string>
#include <vector>

namespace depth_object_tracker {

/// Depth counts of one frame, 0 = no reading.
struct DepthPicture {
  int width = 0;
  int height = 0;
  std::vector<std::uint16_t> counts;  ///< row-major, width * height

  /// View with `unit_m` metres per count; valid while this picture lives unchanged.
  DepthImageView view(double unit_m) const;
};

/// Decodes a 16-bit single-channel PNG.
/// @throws InputError when the file is missing, truncated, not a picture or of another type.
DepthPicture readDepthPicture(const std::string& path);

/// A picture of the given size without any reading.
DepthPicture emptyDepthPicture(int width, int height);

}  // namespace depth_object_tracker
