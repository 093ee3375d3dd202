// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/overlay.h"

#include <sensor_msgs/image_encodings.h>
#include <Eigen/Geometry>
#include <boost/make_shared.hpp>

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

using Color = Eigen::Vector3f;  // blue, green, red in [0, 1]

const Color kNoReading(0.13f, 0.10f, 0.09f);
const Color kVisible(0.35f, 0.85f, 0.25f);
const Color kOccluded(0.20f, 0.20f, 0.95f);
const Color kOutline(1.0f, 1.0f, 1.0f);
constexpr float kTintShare = 0.55f;
constexpr float kShadingReachPerM = 3.0f;  // pixels per metre of depth
constexpr int kMinShadingReach = 2, kMaxShadingReach = 8;
constexpr float kDepthEdge = 0.04f;  // of the depth: beyond it neighbours are on different surfaces

/// Depth as floats with the range that the grey scale spans.
struct Scene {
  int width = 0, height = 0;
  float fx = 1.0f, fy = 1.0f;
  std::vector<float> depth_m;
  float near_m = 0.5f, far_m = 2.0f;

  float at(int row, int col) const { return depth_m[static_cast<std::size_t>(row) * width + col]; }
};

void chooseRange(Scene& scene) {
  std::vector<float> valid;
  for (std::size_t i = 0; i < scene.depth_m.size(); i += 7) {
    if (std::isfinite(scene.depth_m[i])) valid.push_back(scene.depth_m[i]);
  }
  if (valid.size() < 10) return;
  const auto percentile = [&](double share) {
    const auto nth = valid.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(valid.size() - 1));
    std::nth_element(valid.begin(), nth, valid.end());
    return *nth;
  };
  scene.near_m = percentile(0.01);
  scene.far_m = std::max(percentile(0.95), scene.near_m * 1.2f);
}

Scene makeScene(const DepthImageView& depth, const PinholeCamera& camera) {
  Scene scene;
  scene.width = depth.width;
  scene.height = depth.height;
  scene.fx = static_cast<float>(camera.fx);
  scene.fy = static_cast<float>(camera.fy);
  scene.depth_m.reserve(static_cast<std::size_t>(depth.width) * depth.height);
  for (int row = 0; row < depth.height; ++row) {
    for (int col = 0; col < depth.width; ++col) scene.depth_m.push_back(depth.at(row, col));
  }
  chooseRange(scene);
  return scene;
}

/// Slope of the depth between two neighbours [m per pixel]; 0 across an edge or a hole.
float slope(float before, float after, float centre, int pixels) {
  const float difference = after - before;
  return std::abs(difference) < kDepthEdge * centre ? difference / static_cast<float>(pixels) : 0.0f;
}

/// Slopes along both image axes, over a reach that grows with the depth as noise and quantisation do, each the mean of
/// three lines.
Eigen::Vector2f slopesAt(const Scene& scene, int row, int col) {
  const float z = scene.at(row, col);
  const int reach =
      std::clamp(static_cast<int>(std::lround(kShadingReachPerM * z)), kMinShadingReach, kMaxShadingReach);
  const auto clamp_row = [&](int r) { return std::clamp(r, 0, scene.height - 1); };
  const auto clamp_col = [&](int c) { return std::clamp(c, 0, scene.width - 1); };
  const int r0 = clamp_row(row - reach), r1 = clamp_row(row + reach), c0 = clamp_col(col - reach),
            c1 = clamp_col(col + reach);
  Eigen::Vector2f sum = Eigen::Vector2f::Zero();
  for (int side = -reach / 2; side <= reach / 2; side += std::max(1, reach / 2)) {
    const int r = clamp_row(row + side), c = clamp_col(col + side);
    sum.x() += slope(scene.at(r, c0), scene.at(r, c1), z, std::max(1, c1 - c0));
    sum.y() += slope(scene.at(r0, c), scene.at(r1, c), z, std::max(1, r1 - r0));
  }
  return sum / 3.0f;
}

/// Brightness of the surface under a lamp above and left of the camera, in [0, 1].
float shade(const Scene& scene, int row, int col) {
  const float z = scene.at(row, col);
  const Eigen::Vector2f slopes = slopesAt(scene, row, col);
  const Eigen::Vector3f normal =
      Eigen::Vector3f(slopes.x() * scene.fx / z, slopes.y() * scene.fy / z, -1.0f).normalized();
  static const Eigen::Vector3f kToLamp = Eigen::Vector3f(-0.4f, -0.6f, -0.7f).normalized();
  return std::max(0.0f, normal.dot(kToLamp));
}

Color greyOf(const Scene& scene, int row, int col) {
  const float z = scene.at(row, col);
  if (!std::isfinite(z)) return kNoReading;
  const float nearness = (1.0f / z - 1.0f / scene.far_m) / (1.0f / scene.near_m - 1.0f / scene.far_m);
  const float level = 0.30f + 0.45f * std::clamp(nearness, 0.0f, 1.0f);
  return Color::Constant(std::clamp(level * (0.35f + 1.0f * shade(scene, row, col)), 0.0f, 1.0f)) +
         Color(0.02f, 0.005f, 0.0f);
}

/// Occlusion probability at a full-resolution pixel, between the cells around it that have one; 0 where none has.
float occlusionAt(const OcclusionMap& map, int row, int col) {
  if (map.p_occluded.empty()) return 0.0f;
  const float factor = static_cast<float>(map.grid.factor);
  const float r = static_cast<float>(row - map.grid.offset()) / factor,
              c = static_cast<float>(col - map.grid.offset()) / factor;
  const int r0 = static_cast<int>(std::floor(r)), c0 = static_cast<int>(std::floor(c));
  float sum = 0.0f, weight_sum = 0.0f;
  for (int cell_row = r0; cell_row <= r0 + 1; ++cell_row) {
    for (int cell_col = c0; cell_col <= c0 + 1; ++cell_col) {
      if (cell_row < 0 || cell_col < 0 || cell_row >= map.grid.camera.height || cell_col >= map.grid.camera.width)
        continue;
      const float p = map.p_occluded[static_cast<std::size_t>(cell_row) * map.grid.camera.width + cell_col];
      const float weight =
          (1.0f - std::abs(r - static_cast<float>(cell_row))) * (1.0f - std::abs(c - static_cast<float>(cell_col)));
      if (!std::isfinite(p)) continue;
      sum += (weight + 1e-3f) * p;
      weight_sum += weight + 1e-3f;
    }
  }
  return weight_sum > 0.0f ? sum / weight_sum : 0.0f;
}

/// The object's pixels, with what an outline asks for.
class Mask {
 public:
  Mask(const std::vector<float>& rendered, int width, int height)
      : rendered_(rendered), width_(width), height_(height) {}

  bool isObject(int row, int col) const {
    return row >= 0 && col >= 0 && row < height_ && col < width_ &&
           rendered_[static_cast<std::size_t>(row) * width_ + col] > 0.0f;
  }

  /// How much of the pixel an outline of about 2 pixels, drawn around the object, covers: soft edges look drawn by
  /// hand.
  float outlineShare(int row, int col) const {
    if (isObject(row, col)) return 0.0f;
    int touching = 0;
    for (int dr = -1; dr <= 1; ++dr) {
      for (int dc = -1; dc <= 1; ++dc) touching += isObject(row + dr, col + dc) ? 1 : 0;
    }
    if (touching > 0) return 1.0f;
    const bool is_second =
        isObject(row - 2, col) || isObject(row + 2, col) || isObject(row, col - 2) || isObject(row, col + 2);
    return is_second ? 0.4f : 0.0f;
  }

 private:
  const std::vector<float>& rendered_;
  int width_, height_;
};

void store(const Color& color, std::uint8_t* pixel) {
  for (int i = 0; i < 3; ++i) pixel[i] = static_cast<std::uint8_t>(std::clamp(color[i], 0.0f, 1.0f) * 255.0f + 0.5f);
}

sensor_msgs::ImagePtr makeImage(int width, int height) {
  auto image = boost::make_shared<sensor_msgs::Image>();
  image->width = static_cast<std::uint32_t>(width);
  image->height = static_cast<std::uint32_t>(height);
  image->encoding = sensor_msgs::image_encodings::BGR8;
  image->step = 3 * image->width;
  image->data.resize(std::size_t{image->step} * image->height);
  return image;
}

}  // namespace

sensor_msgs::ImagePtr drawOverlay(const DepthImageView& depth, const PinholeCamera& camera,
                                  const std::vector<float>& rendered, const OcclusionMap& occlusion) {
  const Scene scene = makeScene(depth, camera);
  const bool has_object = rendered.size() == scene.depth_m.size();
  const Mask mask(rendered, scene.width, scene.height);
  auto image = makeImage(scene.width, scene.height);
  for (int row = 0; row < scene.height; ++row) {
    for (int col = 0; col < scene.width; ++col) {
      Color color = greyOf(scene, row, col);
      if (has_object && mask.isObject(row, col)) {
        const float p_occluded = occlusionAt(occlusion, row, col);
        const Color tint = (1.0f - p_occluded) * kVisible + p_occluded * kOccluded;
        color = (1.0f - kTintShare) * color + kTintShare * tint * (0.4f + 0.9f * color.mean());
      } else if (has_object) {
        const float share = mask.outlineShare(row, col);
        color = (1.0f - share) * color + share * kOutline;
      }
      store(color, &image->data[static_cast<std::size_t>(row) * image->step + 3 * static_cast<std::size_t>(col)]);
    }
  }
  return image;
}

}  // namespace depth_object_tracker
