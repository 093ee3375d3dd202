// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/frame_budget.h"

#include <algorithm>

namespace depth_object_tracker {
namespace {

// Below, tracking would suffer more than from a late frame.
constexpr double kLeastEffort = 0.05;
// A frame that took too long is answered at once but not as if all frames will: it may have been the machine.
constexpr double kLargestCut = 0.7;
constexpr double kComfortableShare = 0.75;
constexpr double kLargestRise = 1.05;

}  // namespace

void FrameBudget::frameTook(double seconds) {
  if (config_.frame_budget_s <= 0.0 || !(seconds > 0.0)) return;
  const double share = seconds / config_.frame_budget_s;
  if (share > 1.0) {
    effort_ *= std::max(kLargestCut, 1.0 / share);
  } else if (share < kComfortableShare) {
    effort_ *= std::min(kLargestRise, kComfortableShare / share);
  }
  effort_ = std::clamp(effort_, kLeastEffort, 1.0);
}

}  // namespace depth_object_tracker
