// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/simulator/crossing_scene.h"

#include "depth_object_tracker/simulator/pixel_index.h"
#include "depth_object_tracker/simulator/static_world.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

constexpr float kNothingM = 20.0f;
constexpr double kPeriodStep = 0.13;  // so that every pair meets at other phases each time

}  // namespace

CrossingScene::CrossingScene(const std::vector<TriangleMesh>& objects, const CrossingSceneConfig& config)
    : config_(config), sensor_(config.sensor, config.camera, config.seed) {
  for (const TriangleMesh& mesh : objects) {
    renderers_.emplace_back(mesh);
    centroids_.push_back(surfaceCentroid(mesh));
  }
  const std::size_t num_pixels = static_cast<std::size_t>(config.camera.width) * config.camera.height;
  background_m_.assign(num_pixels, kNothingM);
  SimulationConfig world;
  world.camera = config.camera;
  DepthRenderer room(makeStaticWorld(world));
  for (const CoveredPixel& pixel : room.render(Pose::Identity(), config.camera)) {
    background_m_[pixelIndex(pixel, config.camera)] = pixel.depth;
  }
  frame_.depth_mm.assign(num_pixels, 0);
  frame_.T_camera_object.resize(objects.size());
  frame_.visible_fraction.resize(objects.size());
}

Pose CrossingScene::truth(std::size_t object, double stamp_s) const {
  const auto k = static_cast<double>(object);
  const double seed_phase = 0.7 * static_cast<double>(config_.seed);
  const double phase = 2.0 * M_PI * stamp_s / (config_.period_s * (1.0 + kPeriodStep * k)) + 1.9 * k + seed_phase;
  const double depth_m = config_.nearest_m + config_.spacing_m * k;
  // Farther objects swing wider, so that all cover about the same part of the image.
  const double amplitude_m = config_.amplitude_m * (1.0 + 0.15 * k);
  const double lane_m = (object % 2 == 0 ? 1.0 : -1.0) * config_.lane_rad * depth_m;
  Pose T_camera_centre = Pose::Identity();
  T_camera_centre.translation() =
      Eigen::Vector3d(amplitude_m * std::sin(phase), lane_m + 0.01 * std::sin(1.7 * phase + k), depth_m);
  const Eigen::Vector3d turn(std::sin(0.9 * phase + k), std::sin(0.7 * phase + 2.0 * k), std::sin(1.1 * phase));
  T_camera_centre.linear() = expSo3(config_.amplitude_rad * turn) * expSo3(Eigen::Vector3d(1.9, 0.3, -0.4));
  return T_camera_centre * Eigen::Translation3d(-centroids_[object]);
}

const CrossingFrame& CrossingScene::render(double stamp_s) {
  frame_.stamp_s = stamp_s;
  depth_m_ = background_m_;
  std::vector<std::vector<CoveredPixel>> covered;
  for (std::size_t k = 0; k < renderers_.size(); ++k) {
    frame_.T_camera_object[k] = truth(k, stamp_s);
    covered.push_back(renderers_[k].render(frame_.T_camera_object[k], config_.camera));
    for (const CoveredPixel& pixel : covered.back()) {
      float& depth = depth_m_[pixelIndex(pixel, config_.camera)];
      depth = std::min(depth, pixel.depth);
    }
  }
  for (std::size_t k = 0; k < covered.size(); ++k) {
    const auto is_visible = [&](const CoveredPixel& pixel) {
      return depth_m_[pixelIndex(pixel, config_.camera)] >= pixel.depth;
    };
    const auto visible = std::count_if(covered[k].begin(), covered[k].end(), is_visible);
    frame_.visible_fraction[k] =
        covered[k].empty() ? 0.0 : static_cast<double>(visible) / static_cast<double>(covered[k].size());
  }
  sensor_.measure(depth_m_, frame_number_++, frame_.depth_mm.data());
  return frame_;
}

}  // namespace depth_object_tracker
