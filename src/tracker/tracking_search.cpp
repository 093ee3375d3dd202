// SPDX-License-Identifier: BSD-3-Clause
#include "tracker/tracker_implementation.h"

#include <algorithm>

namespace depth_object_tracker {
namespace {

constexpr double kSearchEverywhereAfterS = 3.0;
constexpr double kSettledAfterS = 3.0;
constexpr double kDoubtfulAfterFindS = 0.7;
constexpr double kDoubtfulReachS = 1.5;  // as far as after this long unseen, at most

Vector6d foundVariances() {
  Vector6d variances;
  variances.head<3>().setConstant(0.003 * 0.003);
  variances.tail<3>().setConstant(0.04 * 0.04);
  return variances;
}

/// A pose that was only just found may be turned any way.
Vector6d anyTurnVariances() {
  Vector6d variances;
  variances.head<3>().setConstant(0.02 * 0.02);
  variances.tail<3>().setConstant(1.5 * 1.5);
  return variances;
}

}  // namespace

bool ObjectTracker::Implementation::reacquire(const DepthImageView& depth, double dt_s) {
  if (hidden_start) return false;
  SearchRegion region;
  region.T_camera_centre = last_mean.mean;
  region.variances = searchVariances(unseen_s + dt_s);
  region.is_known = !is_anywhere;
  region.on_table = is_on_table;
  // As long as something in front explains why nothing is seen, the object is most likely still behind it.
  region.everywhere = status.state() == TrackerState::kLost || status.state() == TrackerState::kInitializing ||
                      status.misfit() || unseen_s > kSearchEverywhereAfterS;
  region.occluders = known_occluders;
  const std::optional<Pose> found = reacquisition.search(depth, camera_in_use, region);
  if (!found) return false;
  startAt(*found);
  reacquired_s = 0.0;
  return true;
}

Doubt::Look ObjectTracker::Implementation::whereToLook() const {
  if (!mayReacquire() || initial_variances || status.state() != TrackerState::kTracking) return Doubt::Look::kNowhere;
  if (is_hidden_in_hand) return Doubt::Look::kNowhere;
  if (reacquired_s < kDoubtfulAfterFindS) return Doubt::Look::kAround;
  return doubt.look();
}

bool ObjectTracker::Implementation::moveToBetterPose(const DepthImageView& depth, const Pose& T_camera_centre) {
  const Doubt::Look look = whereToLook();
  if (look == Doubt::Look::kNowhere) return false;
  const bool just_found = reacquired_s < kDoubtfulAfterFindS;
  OtherPoses others;
  others.occluders = known_occluders;
  others.everywhere = look == Doubt::Look::kEverywhere;
  others.by_likelihood = just_found || others.everywhere;
  others.variances = just_found ? anyTurnVariances() : searchVariances(std::min(doubt.poorSince(), kDoubtfulReachS));
  const std::optional<Pose> better = reacquisition.findBetter(depth, camera_in_use, T_camera_centre, others);
  if (better) startAt(*better);
  doubt.looked(look);
  return better.has_value();
}

void ObjectTracker::Implementation::turnToLookAlike(FilterEstimate& estimate, PoseAssessment& assessment, double dt_s) {
  if (!mayReacquire() || is_blind || initial_variances) return;
  if (assessment.visibleShare() < kSeenAboveVisibleFraction) return;
  const double exponent = likelihoodExponent(config.filter, likelihood.image().grid().factor);
  const std::optional<Pose> better =
      look_alikes.findBetter(likelihood, estimate.pose.mean, exponent, moved_s > kSettledAfterS, dt_s);
  if (!better) return;
  filter.moveInObject(estimate.pose.mean.inverse() * *better);
  estimate.pose.mean = *better;
  assessment = assess(estimate);
}

void ObjectTracker::Implementation::startAt(const Pose& T_camera_centre) {
  is_anywhere = false;
  moved_s = 0.0;
  look_alikes.restart();
  filter.initialise(T_camera_centre);
  likelihood.resetOcclusion();
  status.restart();
  initial_variances = foundVariances();
  reacquisition.restart();
}

void ObjectTracker::Implementation::learnFit(const DepthImageView& depth, double dt_s) {
  constexpr double kEveryS = 0.5, kSureAfterS = 1.0, kFits = 0.8;
  since_learnt_s += dt_s;
  // What fits badly from the start may be a bad mesh or a wrong pose; which, time tells.
  const bool is_sure = seen_s > kSureAfterS || status.score() > kFits * reacquisition.usualScore();
  if (!mayReacquire() || !is_seen || !is_sure || moved_s < kSureAfterS || since_learnt_s < kEveryS) return;
  since_learnt_s = 0.0;
  reacquisition.learn(depth, camera_in_use, last_mean.mean);
}

}  // namespace depth_object_tracker
