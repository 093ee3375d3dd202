// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/status_monitor.h"

#include <algorithm>

namespace depth_object_tracker {
namespace {

// Fewer pixels than this say nothing about the fit.
constexpr int kMinPixels = 8;
constexpr double kSeenThroughShare = 0.25;
constexpr double kFoundAfterS = 0.08;  // one image may fit by chance

/// Score that a pose must have to count as found. Part of a wall or a table can fit about as well as a face of the
/// object does, but goes on beyond its outline: the more of the outline does not stand out, the better the fit must be.
double scoreOfAFind(const PoseAssessment& assessment) {
  constexpr double kLeast = 0.55, kPerContinuedShare = 0.9;
  const double continued =
      static_cast<double>(assessment.continued_pixels) / std::max(1, assessment.surrounding_pixels);
  return kLeast + kPerContinuedShare * continued;
}

constexpr double kLittleVisible = 0.3, kMoreOfLittle = 2.8;

}  // namespace

void StatusMonitor::restart() {
  state_ = TrackerState::kInitializing;
  reason_ = "a new initial pose is being fitted to the image";
  misfit_s_ = 0.0;
  visible_fraction_ = 1.0;
  score_ = 0.0;
}

void StatusMonitor::resume(TrackerState state) {
  restart();
  state_ = state;
}

void StatusMonitor::update(const PoseAssessment& assessment, double dt_s, bool is_blind) {
  visible_fraction_ = assessment.visibleShare();
  score_ = assessment.expected > 0.0 ? std::clamp(assessment.achieved / assessment.expected, 0.0, 1.5) : 0.0;
  classify(assessment, dt_s, is_blind);
}

void StatusMonitor::classify(const PoseAssessment& assessment, double dt_s, bool is_blind) {
  if (is_blind && state_ == TrackerState::kInitializing) {
    reason_ = "the whole image is searched for the object: it must be in view, 0.3 to 3 m away and mostly visible";
    return;
  }
  const bool outside = assessment.covered_pixels < kMinPixels;
  const bool unmeasured = !outside && assessment.measured_pixels < kMinPixels;
  const bool hidden = !outside && !unmeasured && visible_fraction_ < config_.occluded_below_visible_fraction;
  // What is in front of the object does not contradict the pose; what is seen through it does.
  const bool seen_through = !unmeasured && assessment.through_pixels > kSeenThroughShare * assessment.measured_pixels;
  // What little is left to be seen may fit something else by chance.
  const bool by_chance = visible_fraction_ < kLittleVisible && score_ < kMoreOfLittle * config_.lost_below_score;
  const bool misfit = outside || (seen_through && (score_ < config_.lost_below_score || by_chance));
  misfit_s_ = misfit ? misfit_s_ + dt_s : 0.0;
  if (misfit_s_ > config_.lost_after_s) {
    if (state_ != TrackerState::kLost) found_s_ = 0.0;
    state_ = TrackerState::kLost;
    reason_ = outside ? "the object has left the image: bring it back into view or give a new initial pose"
                      : "the depth image does not fit the object at any pose near the last one: searching; give a new "
                        "initial pose "
                        "if this lasts";
  } else if (state_ == TrackerState::kLost || state_ == TrackerState::kInitializing) {
    if (misfit || unmeasured || hidden || is_blind) return;
    if (state_ == TrackerState::kLost) {
      found_s_ = score_ >= scoreOfAFind(assessment) ? found_s_ + dt_s : 0.0;
      if (found_s_ < kFoundAfterS) return;
    }
    state_ = TrackerState::kTracking;
    reason_.clear();
  } else if (unmeasured) {
    state_ = TrackerState::kOccluded;
    reason_ =
        "no depth readings where the object is expected: is the lens covered, or the object too near or too shiny?";
  } else if (hidden || is_blind) {
    state_ = TrackerState::kOccluded;
    reason_ = "the object is hidden: holding the last pose until it is seen again";
  } else {
    state_ = TrackerState::kTracking;
    reason_.clear();
  }
}

}  // namespace depth_object_tracker
