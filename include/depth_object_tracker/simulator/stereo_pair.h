// SPDX-License-Identifier: BSD-3-Clause
// A simulated rectified pair of grey cameras beside the depth camera.
#pragma once

#include "depth_object_tracker/simulator/gray_camera.h"
#include "depth_object_tracker/simulator/simulation_config.h"

#include <functional>
#include <vector>

namespace depth_object_tracker {

/// Pose of the left camera in the depth camera's frame; the axes of all three are parallel.
Pose leftCameraPose(const StereoPairConfig& config);

/// Not thread-safe.
class StereoPair {
 public:
  StereoPair(const StereoPairConfig& config, const TriangleMesh& background, const FiducialMap& map,
             std::uint64_t seed);

  /// Draws everything that moves, as a view sees it.
  using DrawScene = std::function<void(const View& view, const DrawSurface& draw)>;

  /// @param left, right row-major grey pictures
  void render(const DrawScene& draw_scene, const Pose& T_camera_object, std::uint64_t number,
              std::vector<std::uint8_t>& left, std::vector<std::uint8_t>& right);

 private:
  GrayCamera left_, right_;
};

}  // namespace depth_object_tracker
