// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/filter/occlusion_memory.h"

#include <algorithm>

namespace depth_object_tracker {
namespace {

// Below this the stored values would lose range in single precision: about 27 s with the default chain.
constexpr float kSmallestScale = 1e-6f;

CellBox enlarge(const CellBox& box, const CellBox& limits) {
  const int rows = box.rows() / 4 + 4, cols = box.cols() / 4 + 4;
  return intersect({box.row_begin - rows, box.row_end + rows, box.col_begin - cols, box.col_end + cols}, limits);
}

}  // namespace

OcclusionMemory::OcclusionMemory(const OcclusionChainConfig& config, int num_particles)
    : chain_(config),
      stationary_(static_cast<float>(chain_.stationary())),
      initial_deviation_(static_cast<float>(config.initial_p_occluded - chain_.stationary())),
      num_particles_(num_particles) {
  reset();
}

void OcclusionMemory::reset() {
  region_ = CellBox();
  num_cells_ = 0;
  setScale(1.0f);
  unmeasured_ = initial_deviation_;
}

void OcclusionMemory::setScale(float scale) {
  scale_ = scale;
  inverse_scale_ = 1.0f / scale;
}

void OcclusionMemory::advance(double dt_s) {
  const double scale = scale_ * chain_.decay(std::max(0.0, dt_s));
  if (scale > kSmallestScale) return setScale(static_cast<float>(scale));
  const auto factor = static_cast<float>(scale);
  for (std::size_t i = 0; i < num_cells_ * static_cast<std::size_t>(num_particles_); ++i) values_[i] *= factor;
  unmeasured_ *= factor;
  setScale(1.0f);
}

void OcclusionMemory::cover(const CellBox& box, const CellBox& image_box) {
  const CellBox wanted = intersect(box, image_box);
  if (wanted.empty() || region_.contains(wanted)) return;
  moveRegion(enlarge(wanted, image_box));
}

void OcclusionMemory::moveRegion(const CellBox& region) {
  const std::size_t cells = static_cast<std::size_t>(region.rows()) * static_cast<std::size_t>(region.cols());
  spare_.assign(cells * static_cast<std::size_t>(num_particles_), unmeasured_);
  const CellBox kept = intersect(region, region_);
  for (int particle_index = 0; particle_index < num_particles_ && !kept.empty() && num_cells_ > 0; ++particle_index) {
    const float* from = particle(particle_index);
    float* to = &spare_[static_cast<std::size_t>(particle_index) * cells];
    for (int row = kept.row_begin; row < kept.row_end; ++row) {
      const float* begin = from + cell(row, kept.col_begin);
      std::copy(begin, begin + kept.cols(),
                to + (row - region.row_begin) * region.cols() + (kept.col_begin - region.col_begin));
    }
  }
  values_.swap(spare_);
  region_ = region;
  num_cells_ = cells;
}

void OcclusionMemory::resampleGrid(const SamplingGrid& from, const SamplingGrid& to) {
  if (region_.empty()) return;
  const auto scaled = [&](int cell_index) {
    const int full = from.offset() + from.factor * cell_index;
    return std::max(0, (full - to.offset() + to.factor / 2) / to.factor);
  };
  const CellBox image_box{0, to.camera.height, 0, to.camera.width};
  const CellBox region = intersect({scaled(region_.row_begin), scaled(region_.row_end - 1) + 1,
                                    scaled(region_.col_begin), scaled(region_.col_end - 1) + 1},
                                   image_box);
  const std::size_t cells =
      static_cast<std::size_t>(std::max(0, region.rows())) * static_cast<std::size_t>(std::max(0, region.cols()));
  spare_.assign(cells * static_cast<std::size_t>(num_particles_), unmeasured_);
  const auto nearest = [&](int full_pixel) { return (full_pixel - from.offset() + from.factor / 2) / from.factor; };
  for (int particle_index = 0; particle_index < num_particles_; ++particle_index) {
    float* out = &spare_[static_cast<std::size_t>(particle_index) * cells];
    for (int row = region.row_begin; row < region.row_end; ++row) {
      const int from_row = nearest(to.fullRow(row));
      for (int col = region.col_begin; col < region.col_end; ++col, ++out) {
        const int from_col = nearest(to.fullCol(col));
        if (inRegion(from_row, from_col)) *out = particle(particle_index)[cell(from_row, from_col)];
      }
    }
  }
  values_.swap(spare_);
  region_ = region;
  num_cells_ = cells;
}

void OcclusionMemory::copy(int from, int to) {
  std::copy(particle(from), particle(from) + num_cells_, particle(to));
}

void OcclusionMemory::mean(const std::vector<double>& weights, std::vector<float>& stored_mean) const {
  stored_mean.assign(num_cells_, 0.0f);
  float* __restrict sum = stored_mean.data();
  for (int index = 0; index < num_particles_; ++index) {
    const auto weight = static_cast<float>(weights[static_cast<std::size_t>(index)]);
    if (weight <= 0.0f) continue;
    const float* __restrict values = particle(index);
    for (std::size_t i = 0; i < num_cells_; ++i) sum[i] += weight * values[i];
  }
}

}  // namespace depth_object_tracker
