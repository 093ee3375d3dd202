// SPDX-License-Identifier: BSD-3-Clause
// How much computing effort a frame may take, so that frames are ready in time on a slow or busy machine.
#pragma once

#include "depth_object_tracker/tracker/tracker_config.h"

namespace depth_object_tracker {

/// Learns from the time that frames took. Takes no time itself: whoever measures it calls frameTook() after each frame
/// and gives effort() to ObjectTracker::setEffort() before the next.
class FrameBudget {
 public:
  explicit FrameBudget(const BudgetConfig& config) : config_(config) {}

  /// @param seconds > 0 that the frame took with the present effort.
  void frameTook(double seconds);

  /// Share of the configured effort, in [least, 1]; 1 without a budget.
  double effort() const { return effort_; }

 private:
  BudgetConfig config_;
  double effort_ = 1.0;
};

}  // namespace depth_object_tracker
