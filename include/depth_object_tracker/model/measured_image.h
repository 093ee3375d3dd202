// SPDX-License-Identifier: BSD-3-Clause
// One depth image at working resolution with everything about its pixels that does not depend on a pose.
#pragma once

#include "depth_object_tracker/geometry/depth_image.h"
#include "depth_object_tracker/geometry/pinhole_camera.h"
#include "depth_object_tracker/model/pixel_model_config.h"

#include <cstdint>
#include <vector>

namespace depth_object_tracker {

/// Rectangle of grid cells, upper ends exclusive.
struct CellBox {
  int row_begin = 0, row_end = 0, col_begin = 0, col_end = 0;
  bool empty() const { return row_begin >= row_end || col_begin >= col_end; }
  bool contains(const CellBox& other) const;
  int rows() const { return row_end - row_begin; }
  int cols() const { return col_end - col_begin; }
};

/// Smallest box that holds both; an empty box does not count.
CellBox unite(const CellBox& a, const CellBox& b);
CellBox intersect(const CellBox& a, const CellBox& b);

/// Constants of one measured pixel; densities as ratios to missDensity (see pixel_likelihood.h).
struct MeasuredPixel {
  float depth = 0.0f;           ///< [m]; 0 = no reading
  float inverse_stddev = 0.0f;  ///< 1 / surfaceNoiseStddev [1/m]
  float visible_peak = 0.0f;    ///< Gaussian part of the visible ratio at d = z
  float tail = 0.0f;            ///< uniform part of every ratio
  float occluded_scale = 0.0f;  ///< occluded ratio - tail, far in front of the object
  float occluded_shift = 0.0f;  ///< shift of the occluder's step, in standard deviations
  float occluded_floor = 0.0f;  ///< paper's second Phi (readings near the lens); 0 for the consistent model
};

/// Ratios of a measured pixel's densities to "no object".
struct PixelRatios {
  float visible;
  float occluded;
  float surface;  ///< Gaussian part of `visible` alone
};

/// Reads pixels from the driver's buffer, only inside of the boxes asked for, once per frame and pixel.
class MeasuredImage {
 public:
  explicit MeasuredImage(const PixelModelConfig& config);

  /// A new frame; the view must stay valid until the next call.
  void setImage(const DepthImageView& view, const SamplingGrid& grid);

  /// Makes pixels in `box` available; grows the region only. Not thread-safe.
  void prepare(const CellBox& box);

  /// True when every cell of `box` is available (cells outside of the image are never needed).
  bool isPrepared(const CellBox& box) const { return prepared_.contains(intersect(box, imageBox())); }

  const SamplingGrid& grid() const { return grid_; }
  CellBox imageBox() const { return {0, grid_.camera.height, 0, grid_.camera.width}; }

  /// Share of the whole image with a reading in range, from an even sample of its cells.
  double validFraction() const;

  /// Only inside of a prepared box.
  const MeasuredPixel& pixel(int row, int col) const {
    return pixels_[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid_.camera.width) + col];
  }

  /// Thread-safe; @param pixel with a reading.
  PixelRatios ratios(const MeasuredPixel& pixel, float rendered_depth_m) const;

  /// Belief p(occluded) to use for a reading. The object may move behind something, or something before the object;
  /// pixels are not independent in that, and if each paid for it on its own the estimate would rather flee. So a
  /// reading far in front of the object counts as occluded with config.min_p_occluded_in_front at least.
  float believedOcclusion(float p_occluded, const MeasuredPixel& pixel, float rendered_depth_m) const;

  /// Address that depth is read from.
  const std::uint8_t* source() const { return view_.data; }

 private:
  MeasuredPixel measure(int row, int col) const;

  PixelModelConfig config_;
  float occluder_rate_;
  float min_p_occluded_in_front_;
  DepthImageView view_;
  SamplingGrid grid_;
  CellBox prepared_;
  std::vector<MeasuredPixel> pixels_;
};

}  // namespace depth_object_tracker
