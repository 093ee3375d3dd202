// SPDX-License-Identifier: BSD-3-Clause
// One depth image at working resolution with everything about its pixels that does not depend on a pose.
#pragma once

#include "depth_object_tracker/geometry/aligned_vector.h"
#include "depth_object_tracker/geometry/depth_image.h"
#include "depth_object_tracker/geometry/pinhole_camera.h"
#include "depth_object_tracker/model/pixel_model_config.h"
#include "depth_object_tracker/render/depth_tile.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace depth_object_tracker {

/// Farther away than anything.
constexpr float kNoOccluder = std::numeric_limits<float>::max();

/// Depth [m] of a pixel without a reading where that says something: it is no reading, but has ratios like one.
constexpr float kMissingReadingM = 1e-6f;

/// Constants of one measured pixel; densities as ratios to missDensity (see pixel_likelihood.h).
struct MeasuredPixel {
  float depth = 0.0f;           ///< [m]; 0 = says nothing, kMissingReadingM = no reading
  float inverse_stddev = 0.0f;  ///< 1 / surfaceNoiseStddev [1/m]
  float visible_peak = 0.0f;    ///< Gaussian part of the visible ratio at d = z; 0 = something else is seen there
  float tail = 0.0f;            ///< uniform part of every ratio; an occluder far in front makes up the rest to 1
  float occluded_shift = 0.0f;  ///< shift of the occluder's step, in standard deviations
  float occluded_floor = 0.0f;  ///< paper's second Phi (readings near the lens); 0 for the consistent model
  float occluder_limit = kNoOccluder;  ///< [m] an object farther away than this is behind a known occluder

  bool hasReading() const { return depth > kMissingReadingM; }
};

/// Ratios of a measured pixel's densities to "no object".
struct PixelRatios {
  float visible;
  float occluded;
  float surface;  ///< Gaussian part of `visible` alone
};

/// The same as planes over the whole grid: cell (row, col) is element row * stride + col. Padded to whole tiles with
/// pixels without a reading.
struct PixelPlanes {
  const float* depth;
  const float* inverse_stddev;
  const float* visible_peak;
  const float* tail;
  const float* occluded_shift;
  const float* occluded_floor;
  int stride;
  const float* occluder_limit = nullptr;  ///< null where there are no known occluders
};

/// normal . p = offset_m, optical frame.
struct BackgroundPlane {
  Eigen::Vector3d normal;  ///< unit length
  double offset_m;
};

/// Of `visible_peak` where a background plane explains the reading just as well as the object would; other readings
/// have far more.
constexpr float kBackgroundPeak = 1.0f;

/// What all pixels share.
struct PixelModel {
  float min_p_occluded_in_front;
  float occluder_rate;  ///< [1/m]
  bool paper_occluder;
  float known_occluder_p_occluded = 0.0f;
};

/// Ramp, in standard deviations in front of the object, over which min_p_occluded_in_front takes hold.
constexpr float kInFrontBegin = 2.12f;
constexpr float kInFrontEnd = 5.88f;

/// Reads pixels from the driver's buffer, only inside of the boxes asked for, once per frame and pixel.
class MeasuredImage {
 public:
  explicit MeasuredImage(const PixelModelConfig& config);

  /// A new frame; the view must stay valid until the next call.
  void setImage(const DepthImageView& view, const SamplingGrid& grid);

  /// Known occluders for this frame, after setImage(). Forgets what is prepared. Where the reading lies behind one, and
  /// config.known_occluder_margin_m more, the occluder is not where it was said to be and does not count.
  /// @param depth_m of the nearest one for each cell of the grid, row-major; 0 = none. Another size is ignored.
  void setOccluders(const std::vector<float>& depth_m);

  /// Surfaces of other things that are seen in this frame, after setImage(). Forgets what is prepared. A reading on one
  /// of them is not the object's, but an occluder's or, before it, free space. @param depth_m as above.
  void setTakenSurfaces(const std::vector<float>& depth_m);
  /// Readings that lie on one of the planes count for "no object" as much as for an object there. Of the pixels that
  /// are prepared.
  void setBackground(const std::vector<BackgroundPlane>& planes);

  /// Makes pixels in `box`, grown to whole tiles, available; grows the region only. Not thread-safe.
  void prepare(const CellBox& box);

  /// True when every cell of `box` is available (cells outside of the image are never needed).
  bool isPrepared(const CellBox& box) const { return prepared_.contains(intersect(box, imageBox())); }

  const SamplingGrid& grid() const { return grid_; }
  const PixelModelConfig& config() const { return config_; }
  CellBox imageBox() const { return {0, grid_.camera.height, 0, grid_.camera.width}; }

  /// Share of the whole image with a reading in range, from an even sample of its cells.
  double validFraction() const;

  /// Only inside of a prepared box.
  MeasuredPixel pixel(int row, int col) const;
  PixelPlanes planes() const;
  const PixelModel& model() const { return model_; }

  /// By which pixels without a reading are weighed, see PixelModelConfig::no_reading_ratio; 1 = they say nothing. Until
  /// the next image.
  void setMissingRatio(float ratio);
  float missingRatio() const { return missing_ratio_; }

  /// Address that depth is read from.
  const std::uint8_t* source() const { return view_.data; }

 private:
  void measureRow(int row, int col_begin, int col_end);
  void computeConstants(std::size_t begin, std::size_t count);
  void computeFloor(std::size_t begin, std::size_t count);
  void weighMissing(std::size_t begin, std::size_t count);
  void dropSeenThrough(std::size_t begin, std::size_t count);
  void excludeTaken(std::size_t begin, std::size_t count);

  PixelModelConfig config_;
  float missing_ratio_;  ///< 1 = pixels without a reading say nothing
  PixelModel model_;
  DepthImageView view_;
  SamplingGrid grid_;
  CellBox prepared_;
  std::size_t stride_ = 0;
  AlignedVector<float> depth_, inverse_stddev_, visible_peak_, tail_, occluded_shift_, occluded_floor_, occluder_limit_,
      taken_depth_;
  bool has_occluders_ = false, has_taken_ = false;
};

/// How far [m] a reading may be from a surface that is seen there: estimate's error and the sensor's noise.
float takenTolerance(float depth_m, const PixelModelConfig& config);

/// Ratios of a pixel with a reading.
PixelRatios pixelRatios(const PixelModel& model, const MeasuredPixel& pixel, float rendered_depth_m);

/// Belief p(occluded) to use for a reading. The object may move behind something, or something before the object;
/// pixels are not independent in that, and if each paid for it on its own the estimate would rather flee. So a
/// reading far in front of the object counts as occluded with config.min_p_occluded_in_front at least, and whatever is
/// behind a known occluder with config.known_occluder_p_occluded.
float believedOcclusion(const PixelModel& model, float p_occluded, const MeasuredPixel& pixel, float rendered_depth_m);

}  // namespace depth_object_tracker
