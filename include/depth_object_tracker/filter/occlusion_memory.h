// SPDX-License-Identifier: BSD-3-Clause
// p(occluded) per particle and pixel, kept in the region around the object.
#pragma once

#include "depth_object_tracker/model/measured_image.h"
#include "depth_object_tracker/model/occlusion_chain.h"

#include <vector>

namespace depth_object_tracker {

/// Stores deviations from the chain's stationary value divided by the decay since the start, so that time moves on for
/// all pixels of all particles by changing one number. Pixels outside of the region hold the belief of a pixel never
/// measured.
class OcclusionMemory {
 public:
  OcclusionMemory(const OcclusionChainConfig& config, int num_particles);

  /// Forgets everything: every pixel starts from p(o_0 = 1).
  void reset();

  /// Moves all beliefs dt_s >= 0 forward.
  void advance(double dt_s);

  /// Makes sure that `box` lies in the region; a larger region around it is taken, so that this is rarely needed.
  /// Pixels that leave the region are forgotten. @param image_box bounds the region.
  void cover(const CellBox& box, const CellBox& image_box);

  /// Carries the beliefs over to another sampling of the same image (nearest cell).
  void resampleGrid(const SamplingGrid& from, const SamplingGrid& to);

  const CellBox& region() const { return region_; }
  bool inRegion(int row, int col) const {
    return row >= region_.row_begin && row < region_.row_end && col >= region_.col_begin && col < region_.col_end;
  }
  std::size_t cell(int row, int col) const {
    return static_cast<std::size_t>(row - region_.row_begin) * static_cast<std::size_t>(region_.cols()) +
           static_cast<std::size_t>(col - region_.col_begin);
  }

  /// Stored values of a particle, one per cell of the region; turn them into probabilities with probability().
  float* particle(int index) { return &values_[static_cast<std::size_t>(index) * num_cells_]; }
  const float* particle(int index) const { return &values_[static_cast<std::size_t>(index) * num_cells_]; }

  float probability(float stored) const { return stationary_ + scale_ * stored; }
  float stored(float probability) const { return (probability - stationary_) * inverse_scale_; }
  /// Stored value of a pixel that was never measured.
  float unmeasured() const { return unmeasured_; }

  void copy(int from, int to);

  /// Weighted mean over the particles of the stored values (linear, hence of the probabilities too).
  void mean(const std::vector<double>& weights, std::vector<float>& stored_mean) const;

 private:
  void moveRegion(const CellBox& region);
  void setScale(float scale);

  OcclusionChain chain_;
  float stationary_;
  float initial_deviation_;
  int num_particles_;
  CellBox region_;
  std::size_t num_cells_ = 0;
  std::vector<float> values_, spare_;
  float scale_ = 1.0f, inverse_scale_ = 1.0f, unmeasured_ = 0.0f;
};

}  // namespace depth_object_tracker
