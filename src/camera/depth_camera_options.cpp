// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/camera/depth_camera_options.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <tuple>

namespace depth_object_tracker {

std::string toString(const DepthMode& mode) {
  return std::to_string(mode.width) + "x" + std::to_string(mode.height) + " at " + std::to_string(mode.fps) + " Hz";
}

DepthMode nearestMode(const std::vector<DepthMode>& supported, const DepthMode& wished) {
  const auto distance = [&](const DepthMode& mode) {
    return std::make_tuple(std::abs(mode.width - wished.width) + std::abs(mode.height - wished.height),
                           std::abs(mode.fps - wished.fps));
  };
  return *std::min_element(supported.begin(), supported.end(),
                           [&](const DepthMode& a, const DepthMode& b) { return distance(a) < distance(b); });
}

bool isRecording(const std::string& device) {
  const std::string suffix = ".oni";
  if (device.size() <= suffix.size()) return false;
  return std::equal(suffix.begin(), suffix.end(), device.end() - static_cast<std::ptrdiff_t>(suffix.size()),
                    [](char a, char b) { return a == std::tolower(static_cast<unsigned char>(b)); });
}

}  // namespace depth_object_tracker
