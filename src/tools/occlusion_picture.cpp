// SPDX-License-Identifier: BSD-3-Clause
// The occlusion belief as an 8-bit picture at the resolution of the input.
#include "depth_object_tracker/tools/occlusion_picture.h"

#include "depth_object_tracker/tools/input_error.h"

#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace depth_object_tracker {
namespace {

constexpr int kSearchCells = 2;  // how far a pixel at the rim of the object looks for a cell with a value

/// Value of the nearest cell that has one, NaN when there is none.
float nearestCellValue(const OcclusionMap& map, int row, int col) {
  float value = std::numeric_limits<float>::quiet_NaN();
  int best = std::numeric_limits<int>::max();
  for (int dr = -kSearchCells; dr <= kSearchCells; ++dr) {
    for (int dc = -kSearchCells; dc <= kSearchCells; ++dc) {
      const int r = row + dr;
      const int c = col + dc;
      if (r < 0 || c < 0 || r >= map.grid.camera.height || c >= map.grid.camera.width) continue;
      const float p = map.p_occluded[static_cast<std::size_t>(r) * static_cast<std::size_t>(map.grid.camera.width) + c];
      const int distance = dr * dr + dc * dc;
      if (std::isnan(p) || distance >= best) continue;
      best = distance;
      value = p;
    }
  }
  return value;
}

int nearestCell(int pixel, const SamplingGrid& grid, int cells) {
  const int cell = static_cast<int>(std::lround(static_cast<double>(pixel - grid.offset()) / grid.factor));
  return std::clamp(cell, 0, std::max(cells - 1, 0));
}

}  // namespace

std::vector<std::uint8_t> makeOcclusionPicture(const OcclusionMap& map, const std::vector<float>& object_depth,
                                               int width, int height, double default_p_occluded) {
  const std::size_t size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  std::vector<std::uint8_t> picture(size, 0);
  if (object_depth.size() != size) return picture;
  const std::size_t cells =
      static_cast<std::size_t>(map.grid.camera.width) * static_cast<std::size_t>(map.grid.camera.height);
  const bool has_map = cells > 0 && map.p_occluded.size() == cells;
  for (std::size_t i = 0; i < size; ++i) {
    if (!(object_depth[i] > 0.0f)) continue;
    const int row =
        nearestCell(static_cast<int>(i / static_cast<std::size_t>(width)), map.grid, map.grid.camera.height);
    const int col = nearestCell(static_cast<int>(i % static_cast<std::size_t>(width)), map.grid, map.grid.camera.width);
    const float value = has_map ? nearestCellValue(map, row, col) : std::numeric_limits<float>::quiet_NaN();
    const double p = std::isnan(value) ? default_p_occluded : static_cast<double>(value);
    picture[i] = static_cast<std::uint8_t>(1 + std::lround(254.0 * std::clamp(p, 0.0, 1.0)));
  }
  return picture;
}

void writeGreyPng(const std::string& path, const std::vector<std::uint8_t>& pixels, int width, int height) {
  const cv::Mat view(height, width, CV_8UC1, const_cast<std::uint8_t*>(pixels.data()));
  bool written = false;
  try {
    written = cv::imwrite(path, view);
  } catch (const cv::Exception&) {
    written = false;
  }
  if (!written) throw InputError("cannot write " + path + ": check that its folder is writable and the disk not full");
}

}  // namespace depth_object_tracker
