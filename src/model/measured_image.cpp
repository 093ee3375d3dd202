// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/model/measured_image.h"

#include "depth_object_tracker/model/normal_table.h"
#include "depth_object_tracker/model/pixel_likelihood.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {

bool CellBox::contains(const CellBox& other) const {
  return other.empty() || (row_begin <= other.row_begin && other.row_end <= row_end && col_begin <= other.col_begin &&
                           other.col_end <= col_end);
}

CellBox unite(const CellBox& a, const CellBox& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.row_begin, b.row_begin), std::max(a.row_end, b.row_end), std::min(a.col_begin, b.col_begin),
          std::max(a.col_end, b.col_end)};
}

CellBox intersect(const CellBox& a, const CellBox& b) {
  return {std::max(a.row_begin, b.row_begin), std::min(a.row_end, b.row_end), std::max(a.col_begin, b.col_begin),
          std::min(a.col_end, b.col_end)};
}

MeasuredImage::MeasuredImage(const PixelModelConfig& config)
    : config_(config),
      occluder_rate_(static_cast<float>(occluderRate(config))),
      min_p_occluded_in_front_(static_cast<float>(config.min_p_occluded_in_front)) {}

void MeasuredImage::setImage(const DepthImageView& view, const SamplingGrid& grid) {
  view_ = view;
  grid_ = grid;
  prepared_ = CellBox();
  const std::size_t num_cells =
      static_cast<std::size_t>(grid.camera.width) * static_cast<std::size_t>(grid.camera.height);
  if (pixels_.size() < num_cells) pixels_.resize(num_cells);
}

void MeasuredImage::prepare(const CellBox& box) {
  const CellBox wanted = intersect(box, imageBox());
  if (wanted.empty() || prepared_.contains(wanted)) return;
  const CellBox grown = unite(prepared_, wanted);
  const auto measureRow = [this](int row, int col_begin, int col_end) {
    MeasuredPixel* out = &pixels_[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid_.camera.width)];
    for (int col = col_begin; col < col_end; ++col) out[col] = measure(row, col);
  };
  for (int row = grown.row_begin; row < grown.row_end; ++row) {
    if (prepared_.empty() || row < prepared_.row_begin || row >= prepared_.row_end) {
      measureRow(row, grown.col_begin, grown.col_end);
    } else {
      measureRow(row, grown.col_begin, prepared_.col_begin);
      measureRow(row, prepared_.col_end, grown.col_end);
    }
  }
  prepared_ = grown;
}

double MeasuredImage::validFraction() const {
  constexpr int kSamplesPerSide = 40;
  int valid = 0, total = 0;
  for (int i = 0; i < kSamplesPerSide; ++i) {
    const int row = (2 * i + 1) * view_.height / (2 * kSamplesPerSide);
    for (int j = 0; j < kSamplesPerSide; ++j, ++total) {
      const float depth = view_.at(row, (2 * j + 1) * view_.width / (2 * kSamplesPerSide));
      valid += depth > 0.0f && depth <= static_cast<float>(config_.max_depth_m) ? 1 : 0;
    }
  }
  return static_cast<double>(valid) / total;
}

MeasuredPixel MeasuredImage::measure(int row, int col) const {
  MeasuredPixel pixel;
  const float depth = view_.at(grid_.fullRow(row), grid_.fullCol(col));
  if (!(depth > 0.0f && depth <= static_cast<float>(config_.max_depth_m))) return pixel;
  const double z = depth;
  const double noise = cameraNoiseStddev(z, config_);
  const double stddev = surfaceNoiseStddev(z, config_);
  const double rate = occluder_rate_;
  const double miss = missDensity(z, config_);
  const double tail = z < config_.max_depth_m ? config_.tail_weight / config_.max_depth_m : 0.0;
  pixel.depth = depth;
  pixel.inverse_stddev = static_cast<float>(1.0 / stddev);
  pixel.visible_peak = static_cast<float>((1.0 - config_.tail_weight) / (stddev * std::sqrt(2.0 * M_PI) * miss));
  pixel.tail = static_cast<float>(tail / miss);
  pixel.occluded_scale = static_cast<float>((miss - tail) / miss);
  pixel.occluded_shift = static_cast<float>(rate * noise * noise / stddev);
  if (config_.occluder_model == OccluderModel::kPaper) {
    pixel.occluded_floor = static_cast<float>(0.5 * std::erfc((z / noise - rate * noise) * M_SQRT1_2));
  }
  return pixel;
}

PixelRatios MeasuredImage::ratios(const MeasuredPixel& pixel, float rendered_depth_m) const {
  const NormalTable& normal = NormalTable::instance();
  const float t = (rendered_depth_m - pixel.depth) * pixel.inverse_stddev;
  float in_front = normal.cdf(t + pixel.occluded_shift);
  if (config_.occluder_model == OccluderModel::kPaper) {
    in_front = std::max(0.0f, in_front - pixel.occluded_floor) / -std::expm1(-occluder_rate_ * rendered_depth_m);
  }
  const float surface = pixel.visible_peak * normal.bell(t);
  return {surface + pixel.tail, pixel.occluded_scale * in_front + pixel.tail, surface};
}

float MeasuredImage::believedOcclusion(float p_occluded, const MeasuredPixel& pixel, float rendered_depth_m) const {
  constexpr float kFarInFrontStddevs = 4.0f;
  const float t = (rendered_depth_m - pixel.depth) * pixel.inverse_stddev - kFarInFrontStddevs;
  if (t < -2.5f) return p_occluded;
  return std::max(p_occluded, min_p_occluded_in_front_ * NormalTable::instance().cdf(t));
}

}  // namespace depth_object_tracker
