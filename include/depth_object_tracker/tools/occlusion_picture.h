// SPDX-License-Identifier: BSD-3-Clause
// The occlusion belief as an 8-bit picture at the resolution of the input.
#pragma once

#include "depth_object_tracker/tracker/tracker_result.h"

#include <cstdint>
#include <string>
#include <vector>

namespace depth_object_tracker {

/// 0 = off the object, 1 + round(254 * p(occluded)) on it. Cells of the map are spread to the nearest pixels; where the
/// map has no value beside a pixel of the object, the nearest cell within two cells counts, else `default_p_occluded`.
/// @param object_depth rendered estimate, width * height, 0 off the object; empty = no object anywhere.
std::vector<std::uint8_t> makeOcclusionPicture(const OcclusionMap& map, const std::vector<float>& object_depth,
                                               int width, int height, double default_p_occluded);

/// Writes width * height 8-bit pixels as PNG. @throws InputError
void writeGreyPng(const std::string& path, const std::vector<std::uint8_t>& pixels, int width, int height);

}  // namespace depth_object_tracker
