// SPDX-License-Identifier: BSD-3-Clause
// Chooses the sub-sampling factor from the object's projected size.
#pragma once

#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/tracker/tracker_config.h"

namespace depth_object_tracker {

/// Keeps a factor until the object covers far more or fewer pixels than aimed at, so that it does not flip to and fro.
class ResolutionChooser {
 public:
  explicit ResolutionChooser(const ResolutionConfig& config) : config_(config) {}

  /// Chooses anew at the next image when something changed.
  void setConfig(const ResolutionConfig& config);

  /// @param full_resolution_pixels that the object covers, > 0 when known; 0 keeps the last factor.
  /// @param share in (0, 1] of the pixels that are aimed at otherwise.
  int choose(double full_resolution_pixels, double share = 1.0);

  void reset() { factor_ = 0; }

 private:
  ResolutionConfig config_;
  int factor_ = 0;  ///< 0 = not chosen yet
};

/// Likelihood exponent gamma: neighbouring pixels of a structured-light camera share their error over a few pixels, so
/// a pixel of a grid n times coarser counts n^2 times as much, until it counts fully.
double likelihoodExponent(const FilterConfig& config, int factor);

/// Variances [m^2, rad^2] of an initial pose that comes without covariance.
Vector6d defaultInitialVariances(const InitialisationConfig& config);

}  // namespace depth_object_tracker
