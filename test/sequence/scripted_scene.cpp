// SPDX-License-Identifier: BSD-3-Clause
#include "scripted_scene.h"

#include "depth_object_tracker/geometry/mesh_loader.h"

#include <algorithm>

namespace depth_object_tracker {
namespace {

constexpr float kWallM = 1.5f;

PinholeCamera makeCamera() {
  PinholeCamera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 525.0;
  camera.cx = 319.5;
  camera.cy = 239.5;
  return camera;
}

ObjectModel loadShippedObject(const std::string& name) {
  ObjectModel object;
  object.name = name;
  object.mesh = loadMesh(std::string(PROJECT_SOURCE_FOLDER) + "/meshes/" + name + ".obj");
  return object;
}

}  // namespace

ScriptedScene::ScriptedScene(const std::string& mesh_name, std::uint64_t seed)
    : camera_(makeCamera()),
      object_(loadShippedObject(mesh_name)),
      renderer_(object_.mesh),
      sensor_(DepthSensorConfig(), camera_, seed),
      meter_(object_.mesh, Symmetries()) {}

const std::vector<std::uint16_t>& ScriptedScene::render(const std::optional<Pose>& T_camera_object,
                                                        const std::optional<Board>& board) {
  const auto num_pixels = static_cast<std::size_t>(camera_.width) * static_cast<std::size_t>(camera_.height);
  true_depth_m_.assign(num_pixels, kWallM);
  const auto see = [&](int row, int col, float depth) {
    float& nearest = true_depth_m_[static_cast<std::size_t>(row * camera_.width + col)];
    nearest = std::min(nearest, depth);
  };
  if (T_camera_object) {
    for (const CoveredPixel& pixel : renderer_.render(*T_camera_object, camera_))
      see(pixel.row, pixel.col, pixel.depth);
  }
  if (board) {
    for (int row = std::max(0, board->begin_row); row < std::min(camera_.height, board->end_row); ++row) {
      for (int col = std::max(0, board->begin); col < std::min(camera_.width, board->end); ++col) {
        see(row, col, static_cast<float>(board->depth_m));
      }
    }
  }
  image_.resize(num_pixels);
  sensor_.measure(true_depth_m_, num_images_++, image_.data());
  return image_;
}

std::pair<int, int> ScriptedScene::columnsOf(const Pose& T_camera_object) {
  std::pair<int, int> columns{camera_.width, 0};
  for (const CoveredPixel& pixel : renderer_.render(T_camera_object, camera_)) {
    columns.first = std::min(columns.first, pixel.col);
    columns.second = std::max(columns.second, pixel.col + 1);
  }
  return columns;
}

DepthImageView ScriptedScene::view(const std::vector<std::uint16_t>& image) const {
  DepthImageView view;
  view.data = reinterpret_cast<const std::uint8_t*>(image.data());
  view.width = camera_.width;
  view.height = camera_.height;
  view.step = static_cast<std::size_t>(camera_.width) * sizeof(std::uint16_t);
  return view;
}

Pose restingPose() {
  Pose pose = Pose::Identity();
  pose.linear() = expSo3({0.0, 0.6, 0.0}) * expSo3({-2.0, 0.0, 0.0});
  pose.translation() << 0.02, 0.08, 0.75;
  return pose;
}

Pose movedBy(const Pose& pose, double x, double y, double z, const Eigen::Vector3d& rotation) {
  Vector6d delta;
  delta << x, y, z, rotation;
  return perturb(pose, delta);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : values[values.size() / 2];
}

}  // namespace depth_object_tracker
