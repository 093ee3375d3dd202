// SPDX-License-Identifier: BSD-3-Clause
// Tells tracking, occlusion and loss apart from how the estimate explains the image.
#pragma once

#include "depth_object_tracker/filter/depth_likelihood.h"
#include "depth_object_tracker/tracker/tracker_config.h"
#include "depth_object_tracker/tracker/tracker_result.h"

#include <string>

namespace depth_object_tracker {

class StatusMonitor {
 public:
  explicit StatusMonitor(const StatusConfig& config) : config_(config) {}

  /// From the next image on.
  void setConfig(const StatusConfig& config) { config_ = config; }

  /// A new initial pose, or a jump of time: INITIALIZING until the estimate fits.
  void restart();
  /// What was taken for the object was not: as before it was found.
  void resume(TrackerState state);
  void reset() { state_ = TrackerState::kUninitialized; }

  /// @param dt_s since the last image that was used. @param is_blind the estimate is not fitted to the image but held
  /// until the object is surely seen again.
  void update(const PoseAssessment& assessment, double dt_s, bool is_blind = false);

  TrackerState state() const { return state_; }
  const std::string& reason() const { return reason_; }
  double visibleFraction() const { return visible_fraction_; }  ///< [0, 1]
  bool misfit() const { return misfit_s_ > 0.0; }               ///< the last image did not fit
  double score() const { return score_; }                       ///< 1 = as the sensor model expects

 private:
  void classify(const PoseAssessment& assessment, double dt_s, bool is_blind);

  StatusConfig config_;
  TrackerState state_ = TrackerState::kUninitialized;
  std::string reason_;
  double visible_fraction_ = 0.0;
  double score_ = 0.0;
  double misfit_s_ = 0.0;  ///< how long the estimate has not fitted
  double found_s_ = 0.0;   ///< LOST: how long it has fitted again
};

}  // namespace depth_object_tracker
