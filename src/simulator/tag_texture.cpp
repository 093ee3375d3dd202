// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/simulator/tag_texture.h"

#include "depth_object_tracker/render/depth_renderer.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depth_object_tracker {
namespace {

constexpr float kInk = 0.06f, kPaper = 0.9f;
constexpr int kSamples = 3;         // per pixel and axis
constexpr double kLiftM = 0.004;    // a card on a curved place sinks into the mesh by less
constexpr double kMinFacing = 0.1;  // cosine; flatter cards are not seen

}  // namespace

TagTexture::TagTexture(const FiducialMap& map) {
  for (const Fiducial& tag : map.tags) cards_.push_back({tag, drawTag(map.family, tag.id)});
}

void TagTexture::paint(const Pose& T_view_object, const PinholeCamera& camera, const std::vector<float>& depth_m,
                       std::vector<float>& gray) const {
  for (const Card& card : cards_) paintCard(card, T_view_object, camera, depth_m, gray);
}

TagTexture::Box TagTexture::boxOf(const Card& card, const Pose& T_view_tag, const PinholeCamera& camera) const {
  const double half = 0.5 * card.tag.size_m * card.picture.width / card.picture.square_width;
  double low_u = std::numeric_limits<double>::infinity(), low_v = low_u, high_u = -low_u, high_v = -low_u;
  for (const double x : {-half, half}) {
    for (const double y : {-half, half}) {
      const Eigen::Vector3d corner = T_view_tag * Eigen::Vector3d(x, y, 0.0);
      if (corner.z() < kNearPlaneM) return {0, 0, 0, 0};
      const Eigen::Vector2d pixel = camera.project(corner);
      low_u = std::min(low_u, pixel.x());
      high_u = std::max(high_u, pixel.x());
      low_v = std::min(low_v, pixel.y());
      high_v = std::max(high_v, pixel.y());
    }
  }
  const auto clamped = [](double x, int size) {
    return static_cast<int>(std::clamp(x, 0.0, static_cast<double>(size)));
  };
  return {clamped(low_v, camera.height), clamped(high_v + 2.0, camera.height), clamped(low_u, camera.width),
          clamped(high_u + 2.0, camera.width)};
}

void TagTexture::paintCard(const Card& card, const Pose& T_view_object, const PinholeCamera& camera,
                           const std::vector<float>& depth_m, std::vector<float>& gray) const {
  const Pose T_view_tag = T_view_object * card.tag.T_object_tag;
  const Eigen::Vector3d normal = T_view_tag.linear().col(2), origin = T_view_tag.translation();
  if (normal.dot(origin.normalized()) < kMinFacing) return;
  const double modules_per_m = card.picture.square_width / card.tag.size_m, middle = 0.5 * card.picture.width;
  const Box box = boxOf(card, T_view_tag, camera);
  for (int row = box.row_begin; row < box.row_end; ++row) {
    for (int col = box.col_begin; col < box.col_end; ++col) {
      const auto index =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(camera.width) + static_cast<std::size_t>(col);
      float sum = 0.0f;
      int covered = 0;
      for (int sample = 0; sample < kSamples * kSamples; ++sample) {
        const int sample_row = sample / kSamples, sample_col = sample % kSamples;
        const double u = col + (sample_col + 0.5) / kSamples - 0.5, v = row + (sample_row + 0.5) / kSamples - 0.5;
        const Eigen::Vector3d ray = camera.ray(u, v);
        const double depth = normal.dot(origin) / normal.dot(ray);
        if (!(depth > 0.0 && depth < static_cast<double>(depth_m[index]) + kLiftM)) continue;
        const Eigen::Vector3d p_tag = T_view_tag.linear().transpose() * (depth * ray - origin);
        const int x = static_cast<int>(std::floor(p_tag.x() * modules_per_m + middle));
        const int y = static_cast<int>(std::floor(p_tag.y() * modules_per_m + middle));
        if (x < 0 || y < 0 || x >= card.picture.width || y >= card.picture.width) continue;
        const int module = y * card.picture.width + x;
        sum += card.picture.modules[static_cast<std::size_t>(module)] > 127 ? kPaper : kInk;
        ++covered;
      }
      const float share = static_cast<float>(covered) / (kSamples * kSamples);
      // The card is as bright as its surface is lit: the light comes from about where the camera is.
      const auto facing = static_cast<float>(normal.dot(camera.ray(col, row).normalized()));
      if (covered > 0)
        gray[index] = (1.0f - share) * gray[index] + sum / (kSamples * kSamples) * (0.4f + 0.6f * facing);
    }
  }
}

}  // namespace depth_object_tracker
