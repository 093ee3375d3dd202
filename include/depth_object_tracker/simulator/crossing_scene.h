// SPDX-License-Identifier: BSD-3-Clause
// Several objects that swing to and fro behind one another, so that each hides each again and again.
#pragma once

#include "depth_object_tracker/render/depth_renderer.h"
#include "depth_object_tracker/simulator/depth_sensor.h"
#include "depth_object_tracker/simulator/simulation_config.h"

#include <cstdint>
#include <vector>

namespace depth_object_tracker {

struct CrossingSceneConfig {
  double nearest_m = 0.62;     ///< distance of the first object's middle
  double spacing_m = 0.17;     ///< from one object to the next, which is farther
  double amplitude_m = 0.15;   ///< of the swing to either side
  double lane_rad = 0.035;     ///< every second object passes so much above the middle, the others below
  double period_s = 5.0;       ///< of the first object's swing; the others' differ a little
  double amplitude_rad = 0.3;  ///< of turning about each axis
  std::uint64_t seed = 1;
  PinholeCamera camera{640, 480, 525.0, 525.0, 319.5, 239.5};
  DepthSensorConfig sensor;
};

struct CrossingFrame {
  double stamp_s = 0.0;
  std::vector<std::uint16_t> depth_mm;   ///< row-major, 0 = no reading
  std::vector<Pose> T_camera_object;     ///< truth: mesh origins in the optical frame, in the order of the objects
  std::vector<double> visible_fraction;  ///< of each object's pixels in the image
};

/// Deterministic for a config and a sequence of stamps. Not thread-safe.
class CrossingScene {
 public:
  /// @param objects the nearest first; metres. The same mesh may be there several times.
  CrossingScene(const std::vector<TriangleMesh>& objects, const CrossingSceneConfig& config);

  /// Renders the image of time `stamp_s` [s]. Valid until the next call.
  const CrossingFrame& render(double stamp_s);

  Pose truth(std::size_t object, double stamp_s) const;

 private:
  CrossingSceneConfig config_;
  std::vector<DepthRenderer> renderers_;
  std::vector<Eigen::Vector3d> centroids_;
  DepthSensor sensor_;
  std::vector<float> background_m_, depth_m_;
  std::uint64_t frame_number_ = 0;
  CrossingFrame frame_;
};

}  // namespace depth_object_tracker
