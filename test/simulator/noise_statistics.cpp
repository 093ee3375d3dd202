// SPDX-License-Identifier: BSD-3-Clause
// Noise on smooth surfaces, holes and edge outliers of depth pictures.
#include "noise_statistics.h"

#include "depth_object_tracker/simulator/pixel_index.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace depth_object_tracker {
namespace {

constexpr int kPatchRadius = 4;
constexpr double kMaxPatchRange = 0.06;  // a patch with more depth than this (times its depth) is not one surface

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Patch {
  bool complete = true;
  double mean = 0.0, range = 0.0, stddev = 0.0, slope = 0.0;
};

// Least-squares plane over a square patch; the three unknowns decouple on a centred grid.
Patch fitPatch(const DepthImageView& depth, int row, int col) {
  constexpr int kSide = 2 * kPatchRadius + 1;
  constexpr double kCount = kSide * kSide;
  Patch patch;
  double sum = 0.0, sum_x = 0.0, sum_y = 0.0, square = 0.0, low = 1e9, high = 0.0, moment = 0.0;
  for (int dy = -kPatchRadius; dy <= kPatchRadius; ++dy) {
    for (int dx = -kPatchRadius; dx <= kPatchRadius; ++dx) {
      const double z = depth.at(row + dy, col + dx);
      if (!(z > 0.0)) {
        patch.complete = false;
        return patch;
      }
      sum += z;
      sum_x += dx * z;
      sum_y += dy * z;
      square += z * z;
      moment += dx * dx;
      low = std::min(low, z);
      high = std::max(high, z);
    }
  }
  patch.mean = sum / kCount;
  patch.range = high - low;
  const double slope_x = sum_x / moment, slope_y = sum_y / moment;
  patch.slope = std::hypot(slope_x, slope_y);
  const double rest = square - kCount * patch.mean * patch.mean - moment * (slope_x * slope_x + slope_y * slope_y);
  patch.stddev = std::sqrt(std::max(0.0, rest) / (kCount - 3.0));
  return patch;
}

}  // namespace

void NoiseStatistics::add(const DepthImageView& depth, const PinholeCamera& camera, const Pose& T_camera_object) {
  addPatches(depth);
  addObject(depth, camera, T_camera_object);
}

void NoiseStatistics::addPatches(const DepthImageView& depth) {
  constexpr int kStep = 5;
  for (int row = kPatchRadius; row < depth.height - kPatchRadius; row += kStep) {
    for (int col = kPatchRadius; col < depth.width - kPatchRadius; col += kStep) {
      const Patch patch = fitPatch(depth, row, col);
      if (!patch.complete || patch.range > kMaxPatchRange * patch.mean) continue;
      const auto limit = std::upper_bound(kDepthBins.begin(), kDepthBins.end(), patch.mean);
      if (limit == kDepthBins.begin() || limit == kDepthBins.end()) continue;
      plane_stddev_m_[static_cast<std::size_t>(limit - kDepthBins.begin()) - 1].push_back(patch.stddev);
    }
  }
}

void NoiseStatistics::addObject(const DepthImageView& depth, const PinholeCamera& camera, const Pose& T_camera_object) {
  const auto& pixels = renderer_.render(T_camera_object, camera);
  std::vector<float> rendered(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height), 0.0f);
  for (const CoveredPixel& pixel : pixels) rendered[pixelIndex(pixel, camera)] = pixel.depth;
  const auto insideBy = [&](const CoveredPixel& pixel, int distance) {
    for (const auto& [dy, dx] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
      const int row = pixel.row + dy * distance, col = pixel.col + dx * distance;
      if (row < 0 || col < 0 || row >= camera.height || col >= camera.width) return false;
      const float there = rendered[static_cast<std::size_t>(row) * static_cast<std::size_t>(camera.width) +
                                   static_cast<std::size_t>(col)];
      if (!(std::abs(there - pixel.depth) < 0.03f)) return false;
    }
    return true;
  };
  std::vector<double> residual;
  for (const CoveredPixel& pixel : pixels) {
    const float measured = depth.at(pixel.row, pixel.col);
    const bool hole = std::isnan(measured);
    if (insideBy(pixel, 5)) {
      ++interior_pixels_;
      interior_holes_ += hole ? 1 : 0;
      const double difference = measured - pixel.depth;
      if (std::abs(difference) < 0.015) residual.push_back(difference);
    } else if (!insideBy(pixel, 2)) {
      ++edge_pixels_;
      edge_holes_ += hole ? 1 : 0;
      edge_behind_ += !hole && measured - pixel.depth > 0.02f ? 1 : 0;
    }
  }
  // Without the mean: a scale error of the camera or of the scanned mesh is not noise.
  const double centre = median(residual);
  for (const double value : residual) residual_m_.push_back(std::abs(value - centre));
}

double NoiseStatistics::planeStddev(std::size_t bin) const {
  return plane_stddev_m_[bin].size() < 50 ? 0.0 : median(plane_stddev_m_[bin]);
}

double NoiseStatistics::objectStddev() const {
  return 1.4826 * median(residual_m_);
}

std::string NoiseStatistics::header() {
  std::string text = "sequence                    | noise about a plane [mm] at ";
  char part[64];
  for (std::size_t bin = 0; bin < kNumBins; ++bin) {
    std::snprintf(part, sizeof(part), "%.2f..%.2f ", kDepthBins[bin], kDepthBins[bin + 1]);
    text += part;
  }
  return text + "m | on the object [mm] | holes inside, at edges [%] | behind at edges [%]";
}

std::string NoiseStatistics::row(const std::string& name) const {
  char part[160];
  std::snprintf(part, sizeof(part), "%-27s |                             ", name.c_str());
  std::string text = part;
  for (std::size_t bin = 0; bin < kNumBins; ++bin) {
    std::snprintf(part, sizeof(part), "%10.2f ", 1000.0 * planeStddev(bin));
    text += part;
  }
  std::snprintf(part, sizeof(part), "  | %18.2f | %12.2f %13.2f | %19.2f", 1000.0 * objectStddev(),
                100.0 * interiorHoleShare(), 100.0 * edgeHoleShare(), 100.0 * edgeOutlierShare());
  return text + part;
}

}  // namespace depth_object_tracker
