// SPDX-License-Identifier: BSD-3-Clause
// Where a rendered pixel lies in a row-major image.
#pragma once

#include "depth_object_tracker/geometry/pinhole_camera.h"
#include "depth_object_tracker/render/depth_renderer.h"

#include <cstddef>

namespace depth_object_tracker {

inline std::size_t pixelIndex(const CoveredPixel& pixel, const PinholeCamera& camera) {
  return static_cast<std::size_t>(pixel.row) * static_cast<std::size_t>(camera.width) +
         static_cast<std::size_t>(pixel.col);
}

}  // namespace depth_object_tracker
