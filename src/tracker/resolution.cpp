// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/resolution.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

constexpr int kMaxFactor = 10;
constexpr int kFactorWhenUnknown = 4;
constexpr double kHysteresis = 1.8;  // ratio to the target pixel count that is tolerated
constexpr double kExponentAtFullResolution = 0.015;

}  // namespace

void ResolutionChooser::setConfig(const ResolutionConfig& config) {
  const bool is_same =
      config.downsampling == config_.downsampling && config.target_model_pixels == config_.target_model_pixels;
  if (!is_same) reset();
  config_ = config;
}

int ResolutionChooser::choose(double full_resolution_pixels, double share) {
  if (config_.downsampling > 0) return config_.downsampling;
  if (full_resolution_pixels <= 0.0) return factor_ > 0 ? factor_ : kFactorWhenUnknown;
  const double target = config_.target_model_pixels * share;
  const double pixels = factor_ > 0 ? full_resolution_pixels / (factor_ * factor_) : 0.0;
  if (pixels > target * kHysteresis || pixels < target / kHysteresis) {
    const double wanted = std::sqrt(full_resolution_pixels / target);
    factor_ = std::clamp(static_cast<int>(std::lround(wanted)), 1, kMaxFactor);
  }
  return factor_;
}

double likelihoodExponent(const FilterConfig& config, int factor) {
  if (config.likelihood_exponent > 0.0) return config.likelihood_exponent;
  return std::min(1.0, kExponentAtFullResolution * factor * factor);
}

Vector6d defaultInitialVariances(const InitialisationConfig& config) {
  return poseVariances(config.position_stddev_m, config.rotation_stddev_rad);
}

}  // namespace depth_object_tracker
