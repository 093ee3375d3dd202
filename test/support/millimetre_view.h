// SPDX-License-Identifier: BSD-3-Clause
// Simulated depth images as the tracker takes them.
#pragma once

#include "depth_object_tracker/geometry/depth_image.h"
#include "depth_object_tracker/geometry/pinhole_camera.h"

#include <cstdint>
#include <vector>

namespace depth_object_tracker {

/// @param depth_mm one for each pixel of the camera, row-major, 0 = no reading; must outlive the view.
inline DepthImageView viewOf(const std::vector<std::uint16_t>& depth_mm, const PinholeCamera& camera) {
  DepthImageView view;
  view.data = reinterpret_cast<const std::uint8_t*>(depth_mm.data());
  view.width = camera.width;
  view.height = camera.height;
  view.step = sizeof(std::uint16_t) * static_cast<std::size_t>(camera.width);
  view.pixel_type = DepthImageView::PixelType::kUint16;
  return view;
}

}  // namespace depth_object_tracker
