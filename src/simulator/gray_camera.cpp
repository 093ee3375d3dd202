// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/simulator/gray_camera.h"

#include "depth_object_tracker/simulator/pixel_index.h"
#include "depth_object_tracker/simulator/random_source.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

constexpr float kNothingM = 20.0f;
constexpr float kRoomReflectance = 0.5f;
constexpr float kAmbient = 0.35f;
constexpr std::uint64_t kStream = 120;
const Eigen::Vector3d kToLight = Eigen::Vector3d(-0.4, -0.7, -0.6).normalized();

}  // namespace

GrayCamera::GrayCamera(const View& view, const TriangleMesh& background, const FiducialMap& map, double noise_stddev,
                       std::uint64_t seed)
    : view_(view), tags_(map), noise_stddev_(noise_stddev), seed_(seed) {
  const std::size_t num_pixels =
      static_cast<std::size_t>(view.camera.width) * static_cast<std::size_t>(view.camera.height);
  background_m_.assign(num_pixels, kNothingM);
  DepthRenderer renderer(background);
  for (const CoveredPixel& pixel : renderer.render(view.T_view_camera, view.camera)) {
    background_m_[pixelIndex(pixel, view.camera)] = pixel.depth;
  }
  begin();
  gray_.resize(num_pixels);
  light();
  background_gray_ = gray_;
  blurred_.resize(num_pixels);
  picture_.resize(num_pixels);
  RandomSource random(seed, kStream);
  noise_.resize(num_pixels);
  for (float& value : noise_) value = static_cast<float>(random.normal());
}

void GrayCamera::begin() {
  depth_m_ = background_m_;
  reflectance_.assign(depth_m_.size(), kRoomReflectance);
}

void GrayCamera::draw(const std::vector<CoveredPixel>& pixels, float reflectance) {
  for (const CoveredPixel& pixel : pixels) {
    const std::size_t index = pixelIndex(pixel, view_.camera);
    if (!(pixel.depth < depth_m_[index])) continue;
    depth_m_[index] = pixel.depth;
    reflectance_[index] = reflectance;
  }
}

const std::vector<std::uint8_t>& GrayCamera::finish(const Pose& T_camera_object, std::uint64_t number) {
  light();
  tags_.paint(view_.T_view_camera * T_camera_object, view_.camera, depth_m_, gray_);
  blur();
  expose(number);
  return picture_;
}

Eigen::Vector3d GrayCamera::pointAt(int row, int col) const {
  const auto index =
      static_cast<std::size_t>(row) * static_cast<std::size_t>(view_.camera.width) + static_cast<std::size_t>(col);
  return static_cast<double>(depth_m_[index]) * view_.camera.ray(col, row);
}

/// By the nearer neighbour of each pair: the farther one may lie on another surface.
Eigen::Vector3d GrayCamera::normalAt(int row, int col) const {
  const Eigen::Vector3d here = pointAt(row, col);
  const auto step = [&](int rows, int cols) {
    const Eigen::Vector3d forward =
        pointAt(std::min(row + rows, view_.camera.height - 1), std::min(col + cols, view_.camera.width - 1)) - here;
    const Eigen::Vector3d backward = here - pointAt(std::max(row - rows, 0), std::max(col - cols, 0));
    const bool take_forward = forward.squaredNorm() > 0.0 &&
                              (backward.squaredNorm() == 0.0 || std::abs(forward.z()) < std::abs(backward.z()));
    return take_forward ? forward : backward;
  };
  return step(1, 0).cross(step(0, 1)).normalized();
}

void GrayCamera::light() {
  for (int row = 0; row < view_.camera.height; ++row) {
    for (int col = 0; col < view_.camera.width; ++col) {
      const auto index =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(view_.camera.width) + static_cast<std::size_t>(col);
      // The room is lit already.
      if (!background_gray_.empty() && depth_m_[index] == background_m_[index]) {
        gray_[index] = background_gray_[index];
        continue;
      }
      const auto lit = static_cast<float>(std::max(0.0, normalAt(row, col).dot(kToLight)));
      gray_[index] = reflectance_[index] * (kAmbient + (1.0f - kAmbient) * lit);
    }
  }
}

/// The lens: binomial, 1 2 1 in both directions.
void GrayCamera::blur() {
  const auto width = static_cast<std::size_t>(view_.camera.width);
  const std::size_t size = gray_.size();
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t left = i == 0 ? i : i - 1, right = i + 1 == size ? i : i + 1;
    blurred_[i] = 0.25f * (gray_[left] + 2.0f * gray_[i] + gray_[right]);
  }
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t above = i < width ? i : i - width, below = i + width >= size ? i : i + width;
    gray_[i] = 0.25f * (blurred_[above] + 2.0f * blurred_[i] + blurred_[below]);
  }
}

void GrayCamera::expose(std::uint64_t number) {
  RandomSource random(seed_ + number, kStream + 1);
  std::size_t from = static_cast<std::size_t>(random.uniform() * static_cast<double>(noise_.size()));
  const auto stddev = static_cast<float>(noise_stddev_);
  for (std::size_t i = 0; i < picture_.size(); ++i) {
    picture_[i] = static_cast<std::uint8_t>(std::clamp(255.0f * gray_[i] + stddev * noise_[from] + 0.5f, 0.0f, 255.0f));
    if (++from == noise_.size()) from = 0;
  }
}

}  // namespace depth_object_tracker
