// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/distractors.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace depth_object_tracker {
namespace {

constexpr double kAtTheObjectM = 0.06;                  // the fingers around it are not a place of their own
constexpr float kObjectWithinM = 0.02f;                 // of its surface: its own readings
constexpr double kLeastReachM = 0.02, kSpeedMps = 0.1;  // how far something moves unseen
constexpr double kMostNat = 5.0;

}  // namespace

void Distractors::expectImages(const PinholeCamera& camera) {
  bytes_.reserve(sizeof(float) * static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height));
}

void Distractors::remember(const DepthImageView& depth, const PinholeCamera& camera, const Pose& T_camera_centre) {
  const std::size_t pixel_bytes = depth.pixel_type == DepthImageView::PixelType::kUint16 ? 2 : 4;
  const std::size_t row_bytes = pixel_bytes * static_cast<std::size_t>(depth.width);
  const auto rows = static_cast<std::size_t>(depth.height);
  bytes_.resize(row_bytes * rows);
  for (std::size_t row = 0; row < rows; ++row) {
    std::memcpy(bytes_.data() + row * row_bytes, depth.data + row * depth.step, row_bytes);
  }
  remembered_ = depth;
  remembered_.data = bytes_.data();
  remembered_.step = row_bytes;
  camera_ = camera;
  T_camera_centre_ = T_camera_centre;
  T_now_remembered_.setIdentity();
  is_unsearched_ = true;
  places_.clear();
}

void Distractors::readDepths() {
  const auto width = static_cast<std::size_t>(camera_.width);
  depth_m_.resize(width * static_cast<std::size_t>(camera_.height));
  for (int row = 0; row < camera_.height; ++row) {
    float* target = depth_m_.data() + static_cast<std::size_t>(row) * width;
    for (int col = 0; col < camera_.width; ++col) target[col] = remembered_.at(row, col);
  }
}

void Distractors::blankObject() {
  Pose T_camera_object = T_camera_centre_;
  T_camera_object.translation() -= T_camera_centre_.linear() * centre_object_;
  for (const CoveredPixel& pixel : renderer_.render(T_camera_object, camera_)) {
    float& z = depth_m_[static_cast<std::size_t>(pixel.row) * static_cast<std::size_t>(camera_.width) +
                        static_cast<std::size_t>(pixel.col)];
    if (std::abs(z - pixel.depth) < kObjectWithinM) z = 0.0f;
  }
}

std::optional<Distractors::Scene> Distractors::unsearched() {
  if (!is_unsearched_) return std::nullopt;
  is_unsearched_ = false;
  remembered_.data = bytes_.data();  // this may have been moved since
  readDepths();
  blankObject();
  Scene scene;
  scene.depth.data = reinterpret_cast<const std::uint8_t*>(depth_m_.data());
  scene.depth.width = camera_.width;
  scene.depth.height = camera_.height;
  scene.depth.step = sizeof(float) * static_cast<std::size_t>(camera_.width);
  scene.depth.pixel_type = DepthImageView::PixelType::kFloat32;
  scene.depth.unit_m = 1.0f;
  scene.camera = camera_;
  scene.T_camera_centre = T_camera_centre_;
  return scene;
}

void Distractors::found(const std::vector<Pose>& T_camera_centre) {
  places_.clear();
  for (const Pose& pose : T_camera_centre) {
    const bool is_object = (pose.translation() - T_camera_centre_.translation()).norm() < kAtTheObjectM;
    if (!is_object) places_.push_back(pose.translation());
  }
}

double Distractors::against(const Pose& T_camera_centre, const Pose& T_camera_expected, double age_s) const {
  if (places_.empty()) return 0.0;
  const Eigen::Vector3d here = T_camera_centre.translation();
  double nearest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& place : places_) {
    nearest = std::min(nearest, (T_now_remembered_ * place - here).squaredNorm());
  }
  const double expected = (T_camera_expected.translation() - here).squaredNorm();
  const double reach_m = kLeastReachM + kSpeedMps * age_s;
  // Either may also have been carried off, anywhere.
  const auto log_moved = [reach_m](double squared_m2) {
    return std::log(std::exp(-squared_m2 / (2.0 * reach_m * reach_m)) + std::exp(-kMostNat));
  };
  return std::max(0.0, log_moved(nearest) - log_moved(expected));
}

}  // namespace depth_object_tracker
