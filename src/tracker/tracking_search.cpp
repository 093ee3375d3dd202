// SPDX-License-Identifier: BSD-3-Clause
#include "tracker/tracker_implementation.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

constexpr double kSearchEverywhereAfterS = 3.0;
constexpr double kSettledAfterS = 3.0;
constexpr double kUsualTurnRad = 0.25;
constexpr double kTrustedForS = 2.0, kSureNat = 2.0, kNotOddNat = -3.0;
constexpr double kDoubtfulAfterFindS = 0.7;
constexpr double kDoubtedAtFirstS = 0.12, kBetweenChecksS = 0.05;  // in every image, and then in some
constexpr double kDoubtfulReachS = 1.5;                            // as far as after this long unseen, at most

Vector6d foundVariances() {
  return poseVariances(0.003, 0.04);
}

/// How far from the truth a pose given by hand may be.
Vector6d givenPoseVariances(const Vector6d& initial_variances) {
  constexpr double kPositionM = 0.03, kRotationRad = 0.3;
  Vector6d variances = initial_variances;
  variances.head<3>() = variances.head<3>().cwiseMax(kPositionM * kPositionM);
  variances.tail<3>() = variances.tail<3>().cwiseMax(kRotationRad * kRotationRad);
  return variances;
}

/// A pose that was only just found may be turned any way.
Vector6d anyTurnVariances() {
  return poseVariances(0.02, 1.5);
}

/// How far an object may go on as it moved when it was last seen, in any direction: a hand seldom goes straight on.
Vector6d movedOn(const Vector6d& velocity, double duration_s) {
  constexpr double kMostM = 0.15, kMostRad = 1.5;
  const double distance_m = std::min(kMostM, velocity.head<3>().norm() * duration_s);
  const double angle_rad = std::min(kMostRad, velocity.tail<3>().norm() * duration_s);
  Vector6d moved;
  moved.head<3>().setConstant(distance_m);
  moved.tail<3>().setConstant(angle_rad);
  return moved;
}

}  // namespace

/// The pose may be farther from the truth than its variances say, or in a hand that was taken for the object.
void ObjectTracker::Implementation::startFromGiven(const DepthImageView& depth, double dt_s,
                                                   const std::optional<ControlInput>& control, const GivenPose& given,
                                                   FilterEstimate& estimate, PoseAssessment& assessment) {
  constexpr double kHardlyEverSquared = 22.5;  // chi squared, 6 degrees of freedom, 99.9 %
  const Vector6d moved = difference(estimate.pose.mean, given.T_camera_centre);
  const bool is_held = grasp_memory.pose().has_value();
  const bool is_out_of_hand = is_held && moved.cwiseAbs2().cwiseQuotient(given.variances).sum() > kHardlyEverSquared;
  if (fits(assessment) && !is_out_of_hand) return;
  if (!is_out_of_hand) {
    filter.initialise(given.T_camera_centre);
    likelihood.resetOcclusion();
    initial_variances = given.variances;
    around_given =
        reacquisition.lookAround(depth, camera_in_use, given.T_camera_centre, givenPoseVariances(given.variances));
    estimate = look(dt_s, control);
    assessment = assess(estimate);
    if (fits(assessment)) return;
  }
  constexpr int kSamplingsInHand = 3;
  const std::optional<Pose> better = reacquisition.findGiven(
      depth, camera_in_use, estimate.pose.mean, given.T_camera_centre, given.variances, is_held ? kSamplingsInHand : 0);
  if (!better) return;
  if (is_held) {
    estimate = lookInHand(depth, dt_s, control, *better);
  } else {
    startAt(*better);
    estimate = look(dt_s, control);
  }
  assessment = assess(estimate);
}

bool ObjectTracker::Implementation::reacquire(const DepthImageView& depth, double dt_s) {
  if (hidden_start) return false;
  // What was found was never surely the object, and is gone: the object may be where it was before.
  constexpr double kBriefS = 1.5;
  if (before_find && doubt.isUnproven() && reacquired_s < kBriefS) forgetFind();
  SearchRegion region;
  region.T_camera_centre = last_mean.mean;
  region.variances = searchVariances(unseen_s + dt_s);
  region.moved_on = movedOn(seen_velocity, unseen_s + dt_s);
  region.seen_distance_m = seen_distance_m;
  region.is_known = !is_anywhere;
  region.on_table = is_on_table;
  // As long as something in front explains why nothing is seen, the object is most likely still behind it.
  region.everywhere = status.state() == TrackerState::kLost || status.state() == TrackerState::kInitializing ||
                      status.misfit() || unseen_s > kSearchEverywhereAfterS;
  region.unseen_s = unseen_s + dt_s;
  region.memory_s = since_remembered_s;
  region.was_followed = since_sure_s - unseen_s < kTrustedForS;
  region.occluders = known_occluders;
  const std::optional<Pose> found = reacquisition.search(depth, camera_in_use, region);
  if (!found || (grasp_memory.pose() && leavesForWorse(depth, *found, *grasp_memory.pose()))) return false;
  before_find.reset();
  if (region.is_known) before_find = BeforeFind{last_mean, seen_velocity, unseen_s, since_sure_s, status.state()};
  startAt(*found);
  keepMoving(*found, dt_s);
  // Found where and how it was expected, it is not compared with what looks alike as if nothing were known.
  constexpr double kExpectedSquared = 6.0;
  if (region.is_known && squaredDistance(*found, region) < kExpectedSquared) {
    turn_prior.stddev_rad = std::sqrt(region.variances[3] + region.moved_on[3] * region.moved_on[3]);
    free_turn.restart(turn_prior.stddev_rad);
  }
  reacquired_s = 0.0;
  doubt.found();
  return true;
}

Doubt::Look ObjectTracker::Implementation::whereToLook() const {
  if (!mayReacquire() || initial_variances || status.state() != TrackerState::kTracking) return Doubt::Look::kNowhere;
  if (is_hidden_in_hand) return Doubt::Look::kNowhere;
  const Doubt::Look look = doubt.look();
  if (reacquired_s >= kDoubtfulAfterFindS || look == Doubt::Look::kEverywhere) return look;
  const bool is_due = reacquired_s < kDoubtedAtFirstS || since_check_s > kBetweenChecksS;
  return is_due ? Doubt::Look::kAround : Doubt::Look::kNowhere;
}

bool ObjectTracker::Implementation::moveToBetterPose(const DepthImageView& depth, const Pose& T_camera_centre,
                                                     double dt_s) {
  const Doubt::Look look = whereToLook();
  if (look == Doubt::Look::kNowhere) return false;
  since_check_s = 0.0;
  const bool just_found = reacquired_s < kDoubtfulAfterFindS;
  OtherPoses others;
  others.occluders = known_occluders;
  others.memory_s = since_remembered_s;
  others.is_unproven = doubt.isUnproven();
  others.everywhere = look == Doubt::Look::kEverywhere;
  others.by_likelihood = just_found || others.everywhere;
  others.variances = just_found ? anyTurnVariances() : searchVariances(std::min(doubt.poorSince(), kDoubtfulReachS));
  // A fast object may have gone on while the estimate was caught by something beside it.
  if (!just_found) others.variances += movedOn(last_velocity, doubt.poorSince() + dt_s).cwiseAbs2();
  if (since_sure_s < kTrustedForS) {
    const Vector6d moved_on = movedOn(seen_velocity, since_sure_s);
    others.reach = (searchVariances(since_sure_s) + moved_on.cwiseAbs2()).head<3>();
  }
  const std::optional<Pose> better = reacquisition.findBetter(depth, camera_in_use, T_camera_centre, others);
  if (better) {
    startAt(*better);
    keepMoving(*better, dt_s);
  }
  doubt.looked(look);
  return better.has_value() || takeBackFind();
}

bool ObjectTracker::Implementation::takeBackFind() {
  constexpr double kNotTheObjectNat = -4.5;
  constexpr int kImages = 2;
  if (!before_find || reacquired_s > kDoubtfulAfterFindS) return false;
  const bool is_contradicted = reacquisition.logOddsNow() < kNotTheObjectNat;
  before_find->contradictions = is_contradicted ? before_find->contradictions + 1 : 0;
  if (before_find->contradictions < kImages) return false;
  forgetFind();
  return true;
}

void ObjectTracker::Implementation::forgetFind() {
  const BeforeFind before = *before_find;
  before_find.reset();
  startAt(before.mean.mean);
  initial_variances.reset();
  last_mean = before.mean;
  seen_velocity = before.seen_velocity;
  unseen_s = before.unseen_s + reacquired_s;
  since_sure_s = before.since_sure_s + reacquired_s;
  reacquired_s = kLongAgoS;
  doubt.restart();
  status.resume(before.state);
  is_blind = true;
}

bool ObjectTracker::Implementation::leaps(const DepthImageView& depth, const FilterEstimate& estimate) {
  constexpr double kLittleVisible = 0.3, kFarM = 0.015, kFarInHandM = 0.008, kLeastNat = -2.5;
  const bool was_followed = status.state() == TrackerState::kTracking || status.state() == TrackerState::kOccluded;
  if (!mayReacquire() || !was_followed || !step_in_use) return false;
  const bool vanishes = status.visibleFraction() < kLittleVisible && since_remembered_s < kTrustedForS;
  if (!vanishes && !follows_hand) return false;
  const Pose predicted = step_in_use->predict(last_mean.mean, last_velocity);
  const double moved_m = (estimate.pose.mean.translation() - predicted.translation()).norm();
  return moved_m > (follows_hand ? kFarInHandM : kFarM) &&
         reacquisition.judge(depth, camera_in_use, estimate.pose.mean) < kLeastNat;
}

void ObjectTracker::Implementation::turnToLookAlike(FilterEstimate& estimate, PoseAssessment& assessment, double dt_s) {
  if (!mayReacquire() || is_blind || initial_variances) return;
  if (assessment.visibleShare() < kSeenAboveVisibleFraction) return;
  const double exponent = likelihoodExponent(config.filter, likelihood.image().grid().factor);
  TurnPrior prior = turn_prior;
  prior.was_followed = moved_s > kSettledAfterS;
  if (prior.was_followed) prior.stddev_rad = free_turn.isFree() ? free_turn.stddevRad() : kUsualTurnRad;
  const std::optional<Pose> better = look_alikes.findBetter(likelihood, estimate.pose.mean, exponent, prior, dt_s);
  if (!better) return;
  const Pose turn = estimate.pose.mean.inverse() * *better;
  free_turn.turned(turn);
  smoother.restart();
  look_alikes.moved(turn);
  filter.moveInObject(turn);
  estimate.pose.mean = *better;
  assessment = assess(estimate);
}

void ObjectTracker::Implementation::turnToMiddle(FilterEstimate& estimate, PoseAssessment& assessment, double dt_s) {
  if (is_blind || !mayReacquire() || !step_in_use) return;
  const double exponent = likelihoodExponent(config.filter, likelihood.image().grid().factor);
  const FreeTurn::Motion motion = {step_in_use->meanVariances()[3], estimate.velocity.tail<3>(), dt_s};
  if (assessment.visibleShare() < kSeenAboveVisibleFraction) return free_turn.wait(estimate.pose.mean, motion);
  const Pose predicted = step_in_use->predict(last_mean.mean, last_velocity);
  const std::optional<Pose> turn = free_turn.update(likelihood, predicted, estimate.pose.mean, exponent, motion);
  const auto shown_part = [this](const Vector6d& velocity, const Pose& pose) {
    return free_turn.shownPart(velocity, pose);
  };
  if (free_turn.isFree()) filter.changeVelocities(shown_part);
  estimate.velocity = shown_part(estimate.velocity, estimate.pose.mean);
  if (!turn) return;
  look_alikes.moved(*turn);
  filter.moveInObject(*turn);
  estimate.pose.mean = estimate.pose.mean * *turn;
  assessment = assess(estimate);
}

void ObjectTracker::Implementation::startAt(const Pose& T_camera_centre) {
  is_anywhere = false;
  moved_s = 0.0;
  since_sure_s = kLongAgoS;
  look_alikes.restart();
  turn_prior = TurnPrior();
  free_turn.restart(turn_prior.stddev_rad);
  filter.initialise(T_camera_centre);
  smoother.restart();
  likelihood.resetOcclusion();
  status.restart();
  initial_variances = foundVariances();
  reacquisition.restart();
}

void ObjectTracker::Implementation::keepMoving(const Pose& T_camera_centre, double dt_s) {
  constexpr double kLongestS = 0.2, kFastestM_s = 2.5, kFastestRad_s = 7.0;
  const double duration_s = since_fitted_s + dt_s;
  if (follows_hand || duration_s <= 0.0 || duration_s > kLongestS) return;
  const Vector6d velocity = difference(T_camera_centre, fitted_pose) / duration_s;
  // Faster is elsewhere, or one of its look-alikes.
  if (velocity.head<3>().norm() > kFastestM_s || velocity.tail<3>().norm() > kFastestRad_s) return;
  filter.shiftVelocities(velocity);
}

void ObjectTracker::Implementation::learnFit(const DepthImageView& depth, double dt_s) {
  constexpr double kEveryS = 0.5, kSureAfterS = 1.0, kFits = 0.8;
  since_learnt_s += dt_s;
  // What fits badly from the start may be a bad mesh or a wrong pose; which, time tells.
  const bool is_sure = seen_s > kSureAfterS || status.score() > kFits * reacquisition.usualScore();
  if (!mayReacquire() || !is_seen || !is_sure || moved_s < kSureAfterS || since_learnt_s < kEveryS) return;
  since_learnt_s = 0.0;
  const double log_odds = reacquisition.learn(depth, camera_in_use, last_mean.mean);
  doubt.judged(log_odds);
  constexpr double kInPlainView = 0.4;
  if (!doubt.isUnproven() && log_odds > kNotOddNat && status.visibleFraction() > kInPlainView) {
    reacquisition.remember(depth, camera_in_use, last_mean.mean);
    since_remembered_s = 0.0;
  }
  if (log_odds > kSureNat) since_sure_s = 0.0;
}

}  // namespace depth_object_tracker
