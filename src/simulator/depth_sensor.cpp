// SPDX-License-Identifier: BSD-3-Clause
// Structured-light camera: edge jitter, projector shadow, noise, disparity quantisation, mixed pixels, drop-outs.
#include "depth_object_tracker/simulator/depth_sensor.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

constexpr std::uint64_t kTileStream = 106;
constexpr std::uint64_t kFrameStream = 1000;
constexpr int kTileSize = 1024;  // rows and columns, a power of two
constexpr int kJitterBorder = 3;

// Separable Gaussian blur with wrap-around, then scaled back to unit variance.
std::vector<float> correlate(const std::vector<float>& white, double stddev_px) {
  const int radius = static_cast<int>(std::ceil(2.5 * stddev_px));
  std::vector<float> kernel(2 * radius + 1);
  for (int k = -radius; k <= radius; ++k) {
    kernel[k + radius] = static_cast<float>(std::exp(-0.5 * k * k / (stddev_px * stddev_px)));
  }
  std::vector<float> source = white, result(white.size());
  for (int pass = 0; pass < 2; ++pass) {
    for (int row = 0; row < kTileSize; ++row) {
      for (int col = 0; col < kTileSize; ++col) {
        float sum = 0.0f;
        for (int k = -radius; k <= radius; ++k) {
          sum += kernel[k + radius] * source[row * kTileSize + ((col + k) & (kTileSize - 1))];
        }
        result[col * kTileSize + row] = sum;  // transposed: the second pass goes along the other axis
      }
    }
    source.swap(result);
  }
  double square = 0.0;
  for (const float value : source) square += static_cast<double>(value) * value;
  const auto scale = static_cast<float>(1.0 / std::sqrt(square / static_cast<double>(source.size())));
  for (float& value : source) value *= scale;
  return source;
}

// How a true depth is read off. Local to this file so that the compiler can run it on many pixels at once.
struct DepthReader {
  float noise_at_nearest, noise_growth, nearest, steps_metres, min_range, max_range;

  DepthReader(const DepthSensorConfig& config, const PinholeCamera& camera)
      : noise_at_nearest(static_cast<float>(config.noise_at_nearest_m)),
        noise_growth(static_cast<float>(config.noise_growth_per_m)),
        nearest(static_cast<float>(config.noise_nearest_m)),
        steps_metres(static_cast<float>(camera.fx * config.baseline_m / config.disparity_step_px)),
        min_range(static_cast<float>(config.min_range_m)),
        max_range(static_cast<float>(config.max_range_m)) {}

  /// @param noise standard normal. @return [mm], 0 = out of range
  std::uint16_t read(float depth_m, float noise) const {
    const float beyond = depth_m - nearest;
    const float stddev = noise_at_nearest + noise_growth * beyond * beyond;
    const float steps = static_cast<float>(static_cast<int>(steps_metres / (depth_m + stddev * noise) + 0.5f));
    const float measured = steps_metres / steps;
    const float millimetres = measured >= min_range && measured <= max_range ? 1000.0f * measured + 0.5f : 0.0f;
    return static_cast<std::uint16_t>(static_cast<int>(millimetres));
  }
};

}  // namespace

DepthSensor::DepthSensor(const DepthSensorConfig& config, const PinholeCamera& camera, std::uint64_t seed)
    : config_(config), camera_(camera), seed_(seed) {
  makeTiles(seed);
  seen_depth_m_.resize(static_cast<std::size_t>(camera.width) * camera.height);
  disparity_.resize(camera.width);
}

void DepthSensor::makeTiles(std::uint64_t seed) {
  RandomSource random(seed, kTileStream);
  std::vector<float> white(static_cast<std::size_t>(kTileSize) * kTileSize);
  for (float& value : white) value = static_cast<float>(random.normal());
  noise_tile_ = correlate(white, config_.correlation_px);
  const auto common = static_cast<float>(std::sqrt(config_.correlated_share));
  const auto own = static_cast<float>(std::sqrt(1.0 - config_.correlated_share));
  for (std::size_t k = 0; k < white.size(); ++k) {
    // Another corner of the white tile, so that both parts are independent.
    noise_tile_[k] = common * noise_tile_[k] + own * white[(k + white.size() / 2) % white.size()];
  }
  jitter_tile_.resize(white.size());
  const auto offset = [&] {
    const double jitter = config_.edge_jitter_px * random.normal();
    return static_cast<int>(std::lround(std::clamp(jitter, -1.0 * kJitterBorder, 1.0 * kJitterBorder)));
  };
  for (std::int32_t& value : jitter_tile_) value = offset() * camera_.width + offset();
}

void DepthSensor::measure(const std::vector<float>& true_depth_m, std::uint64_t frame_number, std::uint16_t* depth_mm) {
  RandomSource random(seed_, kFrameStream + frame_number);
  const auto corner = [&] { return static_cast<int>(random.bits() & (kTileSize - 1)); };
  const int noise_row = corner(), noise_col = corner();
  const float sign = random.uniform() < 0.5 ? -1.0f : 1.0f;
  const int jitter_row = corner(), jitter_col = corner();
  jitterEdges(true_depth_m, jitter_row, jitter_col);
  for (int row = 0; row < camera_.height; ++row) {
    std::uint16_t* row_mm = depth_mm + static_cast<std::size_t>(row) * camera_.width;
    readRow(row, noise_row, noise_col, sign, row_mm);
    blurEdges(row, random, row_mm);
    shadowRow(row, row_mm);
    dropGrazing(true_depth_m, row, random, row_mm);
  }
  dropBlobs(random, depth_mm);
}

void DepthSensor::jitterEdges(const std::vector<float>& true_depth_m, int tile_row, int tile_col) {
  const auto step = static_cast<float>(config_.edge_step_m);
  seen_depth_m_ = true_depth_m;
  for (int row = kJitterBorder; row < camera_.height - kJitterBorder; ++row) {
    const std::int32_t* jitter =
        &jitter_tile_[static_cast<std::size_t>((row + tile_row) & (kTileSize - 1)) * kTileSize];
    const std::size_t base = static_cast<std::size_t>(row) * camera_.width;
    for (int col = kJitterBorder; col < camera_.width - kJitterBorder; ++col) {
      const float here = true_depth_m[base + col];
      const float there = true_depth_m[base + col + jitter[(col + tile_col) & (kTileSize - 1)]];
      // Only edges move: on a slope the neighbour's depth would be noise that no sensor has.
      if (std::abs(there - here) > step) seen_depth_m_[base + col] = there;
    }
  }
}

void DepthSensor::readRow(int row, int tile_row, int tile_col, float sign, std::uint16_t* depth_mm) const {
  const float* noise = &noise_tile_[static_cast<std::size_t>((row + tile_row) & (kTileSize - 1)) * kTileSize];
  const float* seen = &seen_depth_m_[static_cast<std::size_t>(row) * camera_.width];
  const DepthReader reader(config_, camera_);
  // Two runs, so that the tile's end needs no test per pixel.
  for (int begin = 0; begin < camera_.width;) {
    const int tile_begin = (begin + tile_col) & (kTileSize - 1);
    const int count = std::min(camera_.width - begin, kTileSize - tile_begin);
    for (int k = 0; k < count; ++k) depth_mm[begin + k] = reader.read(seen[begin + k], sign * noise[tile_begin + k]);
    begin += count;
  }
}

void DepthSensor::shadowRow(int row, std::uint16_t* depth_mm) {
  const float* seen = &seen_depth_m_[static_cast<std::size_t>(row) * camera_.width];
  const auto metres = static_cast<float>(camera_.fx * config_.baseline_m);
  const int width = camera_.width;
  const int shift = static_cast<int>(metres / 0.2f) + 2;  // nearest surface that is simulated: 0.2 m
  projector_.assign(static_cast<std::size_t>(width) + shift + 2, 0.0f);
  const auto column = [&](int col) { return static_cast<float>(col + shift) - disparity_[col]; };
  for (int col = 0; col < width; ++col) {
    disparity_[col] = metres / std::max(seen[col], 0.2f);
    // A surface reaches from this pixel's projector column into the next one.
    float* hit = &projector_[static_cast<std::size_t>(column(col))];
    hit[0] = std::max(hit[0], disparity_[col]);
    hit[1] = std::max(hit[1], disparity_[col]);
  }
  const auto tolerance = static_cast<float>(config_.shadow_tolerance_px);
  for (int col = 0; col < width; ++col) {
    if (projector_[static_cast<std::size_t>(column(col) + 0.5f)] > disparity_[col] + tolerance) depth_mm[col] = 0;
  }
}

void DepthSensor::blurEdges(int row, RandomSource& random, std::uint16_t* depth_mm) const {
  if (row == 0 || row + 1 == camera_.height) return;
  const DepthReader reader(config_, camera_);
  const int width = camera_.width;
  const auto step = static_cast<float>(config_.edge_step_m);
  const float* seen = &seen_depth_m_[static_cast<std::size_t>(row) * width];
  for (int col = 1; col + 1 < width; ++col) {
    const float neighbours[4] = {seen[col - 1], seen[col + 1], seen[col - width], seen[col + width]};
    const float nearest = std::min(std::min(neighbours[0], neighbours[1]), std::min(neighbours[2], neighbours[3]));
    const float farthest = std::max(std::max(neighbours[0], neighbours[1]), std::max(neighbours[2], neighbours[3]));
    if (farthest - nearest <= step) continue;
    const double choice = random.uniform();
    if (choice < config_.edge_drop_probability) {
      depth_mm[col] = 0;
    } else if (choice < config_.edge_drop_probability + config_.mixed_probability) {
      depth_mm[col] = reader.read(nearest + static_cast<float>(random.uniform()) * (farthest - nearest), 0.0f);
    }
  }
}

void DepthSensor::dropGrazing(const std::vector<float>& true_depth_m, int row, RandomSource& random,
                              std::uint16_t* depth_mm) const {
  if (row == 0 || row + 1 == camera_.height) return;
  const int width = camera_.width;
  const auto square = [](double value) { return value * value; };
  const auto begin = static_cast<float>(square(std::tan(config_.grazing_begin_deg * M_PI / 180.0)));
  const float* depth = &true_depth_m[static_cast<std::size_t>(row) * width];
  for (int col = 1; col + 1 < width; ++col) {
    // The smaller one-sided difference belongs to the surface even beside an edge.
    const float across = std::min(std::abs(depth[col + 1] - depth[col]), std::abs(depth[col] - depth[col - 1]));
    const float down = std::min(std::abs(depth[col + width] - depth[col]), std::abs(depth[col] - depth[col - width]));
    const float metres_per_pixel = depth[col] / static_cast<float>(camera_.fx);
    const float slope_square = (across * across + down * down) / (metres_per_pixel * metres_per_pixel);
    if (slope_square < begin) continue;
    const double angle_deg = std::atan(std::sqrt(static_cast<double>(slope_square))) * 180.0 / M_PI;
    const double share =
        (angle_deg - config_.grazing_begin_deg) / (config_.grazing_end_deg - config_.grazing_begin_deg);
    if (random.uniform() < share) depth_mm[col] = 0;
  }
}

void DepthSensor::dropBlobs(RandomSource& random, std::uint16_t* depth_mm) const {
  for (int k = 0; k < config_.blobs; ++k) {
    const double u = random.uniform(0.0, camera_.width), v = random.uniform(0.0, camera_.height);
    const double radius_u = config_.blob_radius_px * random.uniform(0.5, 1.5);
    const double radius_v = config_.blob_radius_px * random.uniform(0.5, 1.5);
    const int first_row = std::max(0, static_cast<int>(v - radius_v));
    const int last_row = std::min(camera_.height - 1, static_cast<int>(v + radius_v));
    for (int row = first_row; row <= last_row; ++row) {
      const double height = (row - v) / radius_v;
      const double half = radius_u * std::sqrt(std::max(0.0, 1.0 - height * height));
      const int first = std::max(0, static_cast<int>(std::ceil(u - half)));
      const int last = std::min(camera_.width - 1, static_cast<int>(u + half));
      for (int col = first; col <= last; ++col) depth_mm[static_cast<std::size_t>(row) * camera_.width + col] = 0;
    }
  }
}

}  // namespace depth_object_tracker
