// SPDX-License-Identifier: BSD-3-Clause
#include "soak_scene.h"

#include "depth_object_tracker/geometry/mesh_loader.h"

#include <algorithm>

namespace depth_object_tracker {
namespace {

constexpr float kWallM = 1.4f, kBoardM = 0.35f, kNoiseM = 0.001f;
const std::vector<std::string> kMeshes{"bracket", "mug", "box"};

double between(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
}

Eigen::Vector3d vectorBetween(std::mt19937_64& random, double limit) {
  const double x = between(random, -limit, limit), y = between(random, -limit, limit);
  return {x, y, between(random, -limit, limit)};
}

}  // namespace

SoakScene::SoakScene(std::uint64_t seed) : random_(seed) {
  for (const std::string& mesh : kMeshes) {
    renderers_.push_back(
        std::make_unique<DepthRenderer>(loadMesh(std::string(PROJECT_SOURCE_FOLDER) + "/meshes/" + mesh + ".obj")));
  }
  placeAnywhere();
}

PinholeCamera SoakScene::camera() {
  return {160, 120, 142.5, 142.5, 79.5, 59.5};
}

std::string SoakScene::meshUri(std::size_t object) {
  return "package://depth_object_tracker/meshes/" + kMeshes[object] + ".obj";
}

void SoakScene::hideFor(int frames, double share) {
  hidden_frames_ = frames;
  hidden_share_ = share;
}

void SoakScene::vanishFor(int frames) {
  gone_frames_ = frames;
}

void SoakScene::placeAnywhere() {
  truth_.translation() =
      Eigen::Vector3d(between(random_, -0.1, 0.1), between(random_, -0.08, 0.08), between(random_, 0.5, 0.8));
  truth_.linear() = expSo3(vectorBetween(random_, 1.5));
}

const std::vector<float>& SoakScene::next() {
  if (steady_frames_-- <= 0) {  // another direction; back to the middle from far out
    steady_frames_ = 20 + static_cast<int>(random_() % 40);
    twist_.head<3>() = vectorBetween(random_, 0.1) + 0.5 * (Eigen::Vector3d(0, 0, 0.65) - truth_.translation());
    twist_.tail<3>() = vectorBetween(random_, 0.6);
  }
  truth_.translation() += kFrameS * twist_.head<3>();
  truth_.linear() = expSo3(kFrameS * twist_.tail<3>()) * truth_.linear();
  if (gone_frames_ > 0 && --gone_frames_ == 0) placeAnywhere();

  const PinholeCamera lens = camera();
  depth_m_.assign(static_cast<std::size_t>(lens.width) * static_cast<std::size_t>(lens.height), kWallM);
  if (gone_frames_ == 0) {
    for (const CoveredPixel& pixel : renderers_[shown_]->render(truth_, lens)) {
      depth_m_[static_cast<std::size_t>(pixel.row) * static_cast<std::size_t>(lens.width) + pixel.col] = pixel.depth;
    }
  }
  if (hidden_frames_ > 0) {
    --hidden_frames_;
    const auto end = static_cast<std::size_t>(hidden_share_ * lens.width);
    for (std::size_t i = 0; i < depth_m_.size(); ++i) {
      if (i % static_cast<std::size_t>(lens.width) < end) depth_m_[i] = kBoardM;
    }
  }
  for (float& depth : depth_m_) depth += kNoiseM * (static_cast<float>(random_() >> 40) * 0x1p-23f - 1.0f);
  return depth_m_;
}

}  // namespace depth_object_tracker
