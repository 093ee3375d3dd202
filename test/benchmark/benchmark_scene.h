// SPDX-License-Identifier: BSD-3-Clause
// What the benchmarks measure on: depth images of an object of a wanted size, particles about it, and their ancestry.
#pragma once

#include "depth_object_tracker/geometry/depth_image.h"
#include "depth_object_tracker/geometry/pinhole_camera.h"
#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/geometry/triangle_mesh.h"
#include "depth_object_tracker/model/pixel_model_config.h"
#include "depth_object_tracker/render/depth_tile.h"
#include "depth_object_tracker/render/tile_outline.h"

#include <cstdint>
#include <vector>

namespace depth_object_tracker {

/// 640x480 of which every factor-th row and column is used.
SamplingGrid benchmarkGrid(int factor);

/// One object before a wall, a fifth of it behind a plate, with the sensor's noise and gaps.
class BenchmarkScene {
 public:
  static constexpr int kNumFrames = 3;
  static constexpr double kFrameTimeS = 1.0 / 30.0;

  /// @param covered_pixels that the object is to cover on the grid; its distance follows.
  /// @throws std::runtime_error when it cannot be brought to cover as many to within 8 %.
  BenchmarkScene(const TriangleMesh& mesh, int factor, int covered_pixels);

  const SamplingGrid& grid() const { return grid_; }
  const Eigen::Vector3d& centreObject() const { return centre_object_; }
  const Pose& meanPose() const { return T_camera_centre_; }  ///< T_camera_centre
  int coveredPixels() const { return covered_pixels_; }      ///< on the grid, at the mean pose

  /// Frames differ in their noise only. Valid as long as the scene.
  DepthImageView frame(int index) const;

  /// Normal about the mean: 3 mm and 1.5 degrees per axis.
  std::vector<Pose> drawPoses(int count, std::uint64_t seed) const;

  Pose toObject(const Pose& T_camera_centre) const;

 private:
  Pose poseAt(double distance_m) const;
  void drawFrames(const TriangleMesh& mesh);

  SamplingGrid grid_;
  Eigen::Vector3d centre_object_;
  Pose T_camera_centre_;
  int covered_pixels_ = 0;
  std::vector<std::vector<std::uint16_t>> frames_;  // [mm], full resolution
};

/// Ancestors as systematic resampling draws them when weights differ as much as those of a particle filter do
/// (effective sample size: half of the particles).
std::vector<int> drawAncestry(int count, std::uint64_t seed);

/// The outline that DepthLikelihood softens with on a grid of this factor.
OutlineCoverage outlineOn(const SamplingGrid& grid, double edge_stddev_px);

}  // namespace depth_object_tracker
