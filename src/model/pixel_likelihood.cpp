// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/model/pixel_likelihood.h"

#include <cmath>

namespace depth_object_tracker {
namespace {

double normalDensity(double x, double stddev) {
  const double t = x / stddev;
  return std::exp(-0.5 * t * t) / (stddev * std::sqrt(2.0 * M_PI));
}

double normalCdf(double t) {
  return 0.5 * std::erfc(-t * M_SQRT1_2);
}

double tailDensity(double z, const PixelModelConfig& config) {
  return z > 0.0 && z < config.max_depth_m ? config.tail_weight / config.max_depth_m : 0.0;
}

/// Exponential occluder density, blurred by camera noise, before any truncation.
double blurredOccluderDensity(double z, const PixelModelConfig& config) {
  const double rate = occluderRate(config);
  const double noise = cameraNoiseStddev(z, config);
  return (1.0 - config.tail_weight) * rate * std::exp(-rate * z + 0.5 * rate * rate * noise * noise);
}

}  // namespace

double cameraNoiseStddev(double measured_depth_m, const PixelModelConfig& config) {
  return config.depth_noise_per_m * measured_depth_m * measured_depth_m;
}

double surfaceNoiseStddev(double measured_depth_m, const PixelModelConfig& config) {
  return std::hypot(cameraNoiseStddev(measured_depth_m, config), config.object_noise_stddev_m);
}

double occluderRate(const PixelModelConfig& config) {
  return M_LN2 / config.occluder_half_life_m;
}

double visibleDensity(double measured_depth_m, double rendered_depth_m, const PixelModelConfig& config) {
  const double stddev = surfaceNoiseStddev(measured_depth_m, config);
  return (1.0 - config.tail_weight) * normalDensity(measured_depth_m - rendered_depth_m, stddev) +
         tailDensity(measured_depth_m, config);
}

double occludedDensity(double measured_depth_m, double rendered_depth_m, const PixelModelConfig& config) {
  const double z = measured_depth_m;
  const double rate = occluderRate(config);
  const double noise = cameraNoiseStddev(z, config);
  const double shift = rate * noise * noise;
  double in_front = normalCdf((rendered_depth_m - z + shift) / surfaceNoiseStddev(z, config));
  if (config.occluder_model == OccluderModel::kPaper) {
    in_front -= normalCdf((shift - z) / noise);
    in_front /= -std::expm1(-rate * rendered_depth_m);
  }
  return blurredOccluderDensity(z, config) * in_front + tailDensity(z, config);
}

double missDensity(double measured_depth_m, const PixelModelConfig& config) {
  return blurredOccluderDensity(measured_depth_m, config) + tailDensity(measured_depth_m, config);
}

namespace {

PixelUpdate updateMissing(double p_occluded, const PixelModelConfig& config) {
  if (config.occluder_model == OccluderModel::kPaper) return {0.0, p_occluded};
  const double total = (1.0 - p_occluded) * config.no_reading_ratio + p_occluded;
  return {std::log(total), p_occluded / total};
}

}  // namespace

PixelUpdate updatePixel(double measured_depth_m, double rendered_depth_m, double p_occluded,
                        const PixelModelConfig& config) {
  if (!(measured_depth_m > 0.0 && measured_depth_m <= config.max_depth_m)) return updateMissing(p_occluded, config);
  const double visible = (1.0 - p_occluded) * visibleDensity(measured_depth_m, rendered_depth_m, config);
  const double occluded = p_occluded * occludedDensity(measured_depth_m, rendered_depth_m, config);
  const double total = visible + occluded;
  return {std::log(total / missDensity(measured_depth_m, config)), occluded / total};
}

}  // namespace depth_object_tracker
