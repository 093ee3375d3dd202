// SPDX-License-Identifier: BSD-3-Clause
// Structured-light camera: turns true depth into what such a sensor reports.
#pragma once

#include "depth_object_tracker/geometry/pinhole_camera.h"
#include "depth_object_tracker/simulator/random_source.h"
#include "depth_object_tracker/simulator/simulation_config.h"

#include <cstdint>
#include <vector>

namespace depth_object_tracker {

/// Not thread-safe. Equal seed, frame number and input give an equal image.
class DepthSensor {
 public:
  DepthSensor(const DepthSensorConfig& config, const PinholeCamera& camera, std::uint64_t seed);

  /// @param true_depth_m row-major, nearest surface along every beam [m], > 0
  /// @param depth_mm row-major, width * height; 0 = no reading
  void measure(const std::vector<float>& true_depth_m, std::uint64_t frame_number, std::uint16_t* depth_mm);

 private:
  void makeTiles(std::uint64_t seed);
  void jitterEdges(const std::vector<float>& true_depth_m, int tile_row, int tile_col);
  void readRow(int row, int tile_row, int tile_col, float sign, std::uint16_t* depth_mm) const;
  void shadowRow(int row, std::uint16_t* depth_mm);
  void blurEdges(int row, RandomSource& random, std::uint16_t* depth_mm) const;
  void dropGrazing(const std::vector<float>& true_depth_m, int row, RandomSource& random,
                   std::uint16_t* depth_mm) const;
  void dropBlobs(RandomSource& random, std::uint16_t* depth_mm) const;

  DepthSensorConfig config_;
  PinholeCamera camera_;
  std::uint64_t seed_;
  // Random numbers are drawn once: every image looks at the tiles from another random corner.
  std::vector<float> noise_tile_;             // unit variance, partly correlated
  std::vector<std::int32_t> jitter_tile_;     // index offset of the pixel that is seen instead
  std::vector<float> seen_depth_m_;           // true depth after edge jitter
  std::vector<float> disparity_, projector_;  // of one row; projector_: largest disparity per projector column
};

}  // namespace depth_object_tracker
