// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/simulator/stereo_pair.h"

namespace depth_object_tracker {
namespace {

constexpr std::uint64_t kRightSeedOffset = 501;

View viewAt(const StereoPairConfig& config, double along_baseline_m) {
  View view;
  view.camera = config.camera;
  view.T_view_camera = (leftCameraPose(config) * Eigen::Translation3d(along_baseline_m, 0.0, 0.0)).inverse();
  return view;
}

}  // namespace

Pose leftCameraPose(const StereoPairConfig& config) {
  Pose T_camera_left = Pose::Identity();
  T_camera_left.translation() = Eigen::Vector3d(config.left_x_m, config.left_y_m, config.left_z_m);
  return T_camera_left;
}

StereoPair::StereoPair(const StereoPairConfig& config, const TriangleMesh& background, const FiducialMap& map,
                       std::uint64_t seed)
    : left_(viewAt(config, 0.0), background, map, config.noise_stddev, seed),
      right_(viewAt(config, config.baseline_m), background, map, config.noise_stddev, seed + kRightSeedOffset) {}

void StereoPair::render(const DrawScene& draw_scene, const Pose& T_camera_object, std::uint64_t number,
                        std::vector<std::uint8_t>& left, std::vector<std::uint8_t>& right) {
  const auto take = [&](GrayCamera& camera, std::vector<std::uint8_t>& picture) {
    camera.begin();
    draw_scene(camera.view(),
               [&](const std::vector<CoveredPixel>& pixels, float reflectance) { camera.draw(pixels, reflectance); });
    picture = camera.finish(T_camera_object, number);
  };
  take(left_, left);
  take(right_, right);
}

}  // namespace depth_object_tracker
