// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/model/measured_image.h"

#include "depth_object_tracker/model/fast_math.h"
#include "depth_object_tracker/model/pixel_likelihood.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

CellBox wholeTiles(const CellBox& box) {
  const auto down = [](int cell) { return cell / kTileSize * kTileSize; };
  const auto up = [](int cell) { return (cell + kTileSize - 1) / kTileSize * kTileSize; };
  return {down(box.row_begin), up(box.row_end), down(box.col_begin), up(box.col_end)};
}

float configuredMissingRatio(const PixelModelConfig& config) {
  return config.occluder_model == OccluderModel::kPaper ? 1.0f : static_cast<float>(config.no_reading_ratio);
}

}  // namespace

MeasuredImage::MeasuredImage(const PixelModelConfig& config)
    : config_(config),
      missing_ratio_(configuredMissingRatio(config)),
      model_{static_cast<float>(config.min_p_occluded_in_front), static_cast<float>(occluderRate(config)),
             config.occluder_model == OccluderModel::kPaper, static_cast<float>(config.known_occluder_p_occluded)} {}

void MeasuredImage::setImage(const DepthImageView& view, const SamplingGrid& grid) {
  view_ = view;
  grid_ = grid;
  prepared_ = CellBox();
  has_occluders_ = has_taken_ = false;
  missing_ratio_ = configuredMissingRatio(config_);
  const CellBox padded = wholeTiles(imageBox());
  stride_ = static_cast<std::size_t>(padded.cols());
  const std::size_t num_cells = stride_ * static_cast<std::size_t>(padded.rows());
  for (auto* plane : {&depth_, &inverse_stddev_, &visible_peak_, &tail_, &occluded_shift_, &occluded_floor_}) {
    if (plane->size() != num_cells) plane->assign(num_cells, 0.0f);
  }
}

void MeasuredImage::setMissingRatio(float ratio) {
  if (ratio == missing_ratio_) return;
  const bool are_marked = missing_ratio_ < 1.0f;
  missing_ratio_ = ratio;
  if (!are_marked) {
    prepared_ = CellBox();
    return;
  }
  for (int row = prepared_.row_begin; row < prepared_.row_end; ++row) {
    weighMissing(static_cast<std::size_t>(row) * stride_ + static_cast<std::size_t>(prepared_.col_begin),
                 static_cast<std::size_t>(prepared_.cols()));
  }
}

void MeasuredImage::setOccluders(const std::vector<float>& depth_m) {
  const auto rows = static_cast<std::size_t>(grid_.camera.height), cols = static_cast<std::size_t>(grid_.camera.width);
  prepared_ = CellBox();
  has_occluders_ = depth_m.size() == rows * cols && model_.known_occluder_p_occluded > 0.0f;
  if (!has_occluders_) return;
  occluder_limit_.assign(depth_.size(), kNoOccluder);
  const auto margin = static_cast<float>(config_.known_occluder_margin_m);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t col = 0; col < cols; ++col) {
      const float depth = depth_m[row * cols + col];
      if (depth > 0.0f) occluder_limit_[row * stride_ + col] = depth + margin;
    }
  }
}

void MeasuredImage::setTakenSurfaces(const std::vector<float>& depth_m) {
  const auto rows = static_cast<std::size_t>(grid_.camera.height), cols = static_cast<std::size_t>(grid_.camera.width);
  prepared_ = CellBox();
  has_taken_ = depth_m.size() == rows * cols;
  if (!has_taken_) return;
  taken_depth_.assign(depth_.size(), 0.0f);
  for (std::size_t row = 0; row < rows; ++row) {
    std::copy_n(depth_m.begin() + static_cast<std::ptrdiff_t>(row * cols), cols,
                taken_depth_.begin() + static_cast<std::ptrdiff_t>(row * stride_));
  }
}

void MeasuredImage::setBackground(const std::vector<BackgroundPlane>& planes) {
  constexpr double kLeastToleranceM = 0.003, kNoiseStddevs = 2.0;
  const PinholeCamera& camera = grid_.camera;
  for (int row = prepared_.row_begin; row < std::min(prepared_.row_end, camera.height); ++row) {
    for (int col = prepared_.col_begin; col < std::min(prepared_.col_end, camera.width); ++col) {
      const std::size_t i = static_cast<std::size_t>(row) * stride_ + static_cast<std::size_t>(col);
      const double z = depth_[i], tolerance = kLeastToleranceM + kNoiseStddevs * config_.depth_noise_per_m * z * z;
      const Eigen::Vector3d p = z * camera.ray(col, row);
      const bool explained = std::any_of(planes.begin(), planes.end(), [&](const BackgroundPlane& plane) {
        return std::abs(plane.normal.dot(p) - plane.offset_m) < tolerance;
      });
      if (explained) visible_peak_[i] = std::min(visible_peak_[i], kBackgroundPeak);
    }
  }
}

void MeasuredImage::prepare(const CellBox& box) {
  const CellBox wanted = intersect(box, imageBox());
  if (wanted.empty() || prepared_.contains(wanted)) return;
  const CellBox grown = wholeTiles(unite(prepared_, wanted));
  for (int row = grown.row_begin; row < std::min(grown.row_end, grid_.camera.height); ++row) {
    if (prepared_.empty() || row < prepared_.row_begin || row >= prepared_.row_end) {
      measureRow(row, grown.col_begin, grown.col_end);
    } else {
      measureRow(row, grown.col_begin, prepared_.col_begin);
      measureRow(row, prepared_.col_end, grown.col_end);
    }
  }
  prepared_ = grown;
}

void MeasuredImage::measureRow(int row, int col_begin, int col_end) {
  const std::size_t begin = static_cast<std::size_t>(row) * stride_ + static_cast<std::size_t>(col_begin);
  const auto max_depth = static_cast<float>(config_.max_depth_m);
  for (int col = col_begin; col < col_end; ++col) {
    const bool exists = col < grid_.camera.width;
    const float z = exists ? view_.at(grid_.fullRow(row), grid_.fullCol(col)) : 0.0f;
    const float missing = exists && missing_ratio_ < 1.0f ? kMissingReadingM : 0.0f;
    depth_[begin + static_cast<std::size_t>(col - col_begin)] = z > 0.0f && z <= max_depth ? z : missing;
  }
  const auto count = static_cast<std::size_t>(std::max(0, col_end - col_begin));
  computeConstants(begin, count);
  if (model_.paper_occluder) computeFloor(begin, count);
  if (missing_ratio_ < 1.0f) weighMissing(begin, count);
  if (has_occluders_) dropSeenThrough(begin, count);
  if (has_taken_) excludeTaken(begin, count);
}

/// At any depth of the object the ratios are missing_ratio_ where it is visible, and 1 where it is occluded: the shift
/// lifts Phi(0) = 1/2 to 1.
void MeasuredImage::weighMissing(std::size_t begin, std::size_t count) {
  constexpr float kHardlyAny = 1e-4f;  // inverse of a standard deviation
  for (std::size_t i = begin; i < begin + count; ++i) {
    if (depth_[i] != kMissingReadingM) continue;
    if (missing_ratio_ >= 1.0f) depth_[i] = 0.0f;
    inverse_stddev_[i] = kHardlyAny;
    visible_peak_[i] = 0.0f;
    tail_[i] = missing_ratio_;
    occluded_shift_[i] = 0.5f / fast_math::kInverseSqrt2Pi;
    occluded_floor_[i] = 0.0f;
  }
}

void MeasuredImage::dropSeenThrough(std::size_t begin, std::size_t count) {
  for (std::size_t i = begin; i < begin + count; ++i) {
    if (depth_[i] > occluder_limit_[i]) occluder_limit_[i] = kNoOccluder;
  }
}

void MeasuredImage::excludeTaken(std::size_t begin, std::size_t count) {
  for (std::size_t i = begin; i < begin + count; ++i) {
    const float taken = taken_depth_[i];
    if (taken > 0.0f && std::abs(depth_[i] - taken) < takenTolerance(taken, config_)) visible_peak_[i] = 0.0f;
  }
}

// One loop without branches, for the compiler to vectorise. Pixels without a reading get numbers that nobody uses.
void MeasuredImage::computeConstants(std::size_t begin, std::size_t count) {
  const auto max_depth = static_cast<float>(config_.max_depth_m), tail_weight = static_cast<float>(config_.tail_weight);
  const auto object_noise = static_cast<float>(config_.object_noise_stddev_m);
  const auto noise_per_m = static_cast<float>(config_.depth_noise_per_m);
  const float rate = model_.occluder_rate;
  const float* __restrict depth = &depth_[begin];
  float* __restrict inverse_stddevs = &inverse_stddev_[begin];
  float* __restrict peaks = &visible_peak_[begin];
  float* __restrict tails = &tail_[begin];
  float* __restrict shifts = &occluded_shift_[begin];
  for (std::size_t i = 0; i < count; ++i) {
    const float z = depth[i];
    const float noise = noise_per_m * z * z;
    const float inverse_stddev = 1.0f / std::sqrt(noise * noise + object_noise * object_noise);
    // As missDensity() has it.
    const float tail = z < max_depth ? tail_weight / max_depth : 0.0f;
    const float occluder = (1.0f - tail_weight) * rate * fastExp(-rate * z + 0.5f * rate * rate * noise * noise);
    const float inverse_miss = 1.0f / (occluder + tail);
    inverse_stddevs[i] = inverse_stddev;
    peaks[i] = (1.0f - tail_weight) * fast_math::kInverseSqrt2Pi * inverse_stddev * inverse_miss;
    tails[i] = tail * inverse_miss;
    shifts[i] = rate * noise * noise * inverse_stddev;
  }
}

void MeasuredImage::computeFloor(std::size_t begin, std::size_t count) {
  for (std::size_t i = begin; i < begin + count; ++i) {
    const double z = depth_[i], noise = cameraNoiseStddev(z, config_);
    occluded_floor_[i] =
        z > 0.0 ? static_cast<float>(0.5 * std::erfc((z / noise - model_.occluder_rate * noise) * M_SQRT1_2)) : 0.0f;
  }
}

MeasuredPixel MeasuredImage::pixel(int row, int col) const {
  const std::size_t i = static_cast<std::size_t>(row) * stride_ + static_cast<std::size_t>(col);
  return {depth_[i],
          inverse_stddev_[i],
          visible_peak_[i],
          tail_[i],
          occluded_shift_[i],
          occluded_floor_[i],
          has_occluders_ ? occluder_limit_[i] : kNoOccluder};
}

PixelPlanes MeasuredImage::planes() const {
  return {depth_.data(),
          inverse_stddev_.data(),
          visible_peak_.data(),
          tail_.data(),
          occluded_shift_.data(),
          occluded_floor_.data(),
          static_cast<int>(stride_),
          has_occluders_ ? occluder_limit_.data() : nullptr};
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

float takenTolerance(float depth_m, const PixelModelConfig& config) {
  constexpr double kEstimateErrorM = 0.005, kNoiseStddevs = 4.0;
  return static_cast<float>(kEstimateErrorM + kNoiseStddevs * cameraNoiseStddev(depth_m, config));
}

PixelRatios pixelRatios(const PixelModel& model, const MeasuredPixel& pixel, float rendered_depth_m) {
  const float t = (rendered_depth_m - pixel.depth) * pixel.inverse_stddev;
  const float bell = fastExp((-0.5f * t) * t);
  const float tail = fastNormalTail(std::fabs(t), bell);
  const float step = t < 0.0f ? tail : 1.0f - tail;
  // Phi(t + shift) to second order: the shift is a few hundredths at most.
  const float shift = pixel.occluded_shift;
  float in_front = step + ((shift * bell) * fast_math::kInverseSqrt2Pi) * (1.0f - (0.5f * t) * shift);
  if (model.paper_occluder) {
    const float above_floor = in_front - pixel.occluded_floor;
    in_front = (above_floor > 0.0f ? above_floor : 0.0f) / (1.0f - fastExp(-model.occluder_rate * rendered_depth_m));
  }
  const float surface = pixel.visible_peak * bell;
  return {surface + pixel.tail, (1.0f - pixel.tail) * in_front + pixel.tail, surface};
}

float believedOcclusion(const PixelModel& model, float p_occluded, const MeasuredPixel& pixel, float rendered_depth_m) {
  const float t = (rendered_depth_m - pixel.depth) * pixel.inverse_stddev;
  const float share = std::min(std::max((t - kInFrontBegin) * (1.0f / (kInFrontEnd - kInFrontBegin)), 0.0f), 1.0f);
  const float floor = model.min_p_occluded_in_front * ((share * share) * (3.0f - (share + share)));
  const float known = rendered_depth_m > pixel.occluder_limit ? model.known_occluder_p_occluded : 0.0f;
  return std::max(p_occluded, std::max(floor, known));
}

}  // namespace depth_object_tracker
