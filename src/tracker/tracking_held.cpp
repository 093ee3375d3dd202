// SPDX-License-Identifier: BSD-3-Clause
#include "tracker/tracker_implementation.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

// Of an object in a robot's hand: error of the mesh and the sensor, and how fast it may slip.
constexpr double kHeldReachM = 0.004, kHeldSpeedM_s = 0.1;
// What little is seen contradicts the hand: the object has slipped where it is hidden, and is looked for.
constexpr double kSlippedScore = 0.7, kSlippedAfterS = 0.09, kSlippedForS = 1.0;
// Where a hand has an object that was not seen yet is worth knowing up to here; then it is searched as any other.
constexpr double kMostHiddenStddevM = 0.05, kMostHiddenStddevRad = 0.5;
// Of what is found beside the hand. A hand goes on beside the outline, however well it fits; and where no outline is
// seen before something behind it, what little is seen may slide along.
constexpr double kLeastVisibleShare = 0.1, kLeastScore = 0.85, kMostThrough = 0.02;
constexpr double kMostContinued = 0.08, kLeastBeyond = 0.1;
constexpr int kLeastVisibleCells = 40;
constexpr double kMostReachM = 0.015;  // what is nearer than that is the hand's

/// How far an object may have slipped, and the kinematics be wrong, since it was last surely seen.
Vector6d inHandVariances() {
  return poseVariances(0.01, 0.15);
}

/// Of a pose that was found in the hand: what is beside it, and fits worse but explains more, is farther.
Vector6d sampledVariances() {
  return poseVariances(0.0015, 0.02);
}

}  // namespace

void ObjectTracker::Implementation::setAsideWhatIsNotHeld(const DepthImageView& depth, const SamplingGrid& grid,
                                                          double dt_s, const std::optional<ControlInput>& control) {
  const bool was_hidden = is_hidden_in_hand;
  is_hidden_in_hand = false;
  if (waitForTheHandToShowIt(depth, grid, dt_s, control)) return;
  const bool is_contradicted = was_hidden && status.score() < kSlippedScore * scoreInHand();
  contradicted_s = is_contradicted ? contradicted_s + dt_s : 0.0;
  slipped_unseen_s = contradicted_s > kSlippedAfterS ? 0.0 : slipped_unseen_s + dt_s;
  const bool may_have_slipped = slipped_unseen_s < kSlippedForS;
  if (may_have_slipped || !follows_hand || is_blind || initial_variances || !control || !control->isFollowed() ||
      !mayReacquire()) {
    held_view.reset();
    return;
  }
  const ProcessStep step(config.process, dt_s, control, centre_object, 1.0);
  const Pose carried = perturb(last_mean.mean, step.controlDisplacement(last_mean.mean));
  const Vector6d stddevs = last_mean.covariance.diagonal().cwiseSqrt();
  const double surface_stddev_m =
      std::hypot(stddevs.head<3>().maxCoeff(), shape.radius_m * stddevs.tail<3>().maxCoeff());
  const double reach_m = kHeldReachM + 3.0 * surface_stddev_m + (was_hidden ? 0.0 : kHeldSpeedM_s * dt_s);
  const std::vector<float>& foreign = held_view.foreignReadings(depth, grid, toObject(carried), reach_m);
  is_hidden_in_hand = !foreign.empty();
  if (!is_hidden_in_hand) return;
  likelihood.setTakenSurfaces(foreign);
  filter.stopMotion();  // in the hand: a slip cannot be told from what so little shows
}

/// A pose from kinematics of an object that the hand hides from the first image on: nothing fits, and a search would
/// only find something else. The pose goes where the hand carries it; the first image that shows more of the object is
/// looked at as any first one.
bool ObjectTracker::Implementation::waitForTheHandToShowIt(const DepthImageView& depth, const SamplingGrid& grid,
                                                           double dt_s, const std::optional<ControlInput>& control) {
  const bool is_new = is_given && initial_variances.has_value();
  const bool is_first = is_new && control && control->isFollowed() && mayReacquire();
  if (is_first) {
    hidden_start = HiddenStart{filter.poses().front(), *initial_variances};
  } else if (hidden_start && !is_new && !is_anywhere && status.state() == TrackerState::kInitializing) {
    // Also when the robot falls silent: the pose stays, and is known less and less.
    const ProcessStep step(config.process, dt_s, control, centre_object, 1.0);
    hidden_start->T_camera_centre =
        perturb(hidden_start->T_camera_centre, step.controlDisplacement(hidden_start->T_camera_centre));
    hidden_start->variances += step.component(0).variances;
  } else {
    hidden_start.reset();
    return false;
  }
  const double stddev_m = std::sqrt(hidden_start->variances.head<3>().maxCoeff());
  const double stddev_rad = std::sqrt(hidden_start->variances.tail<3>().maxCoeff());
  if (!is_first && (stddev_m > kMostHiddenStddevM || stddev_rad > kMostHiddenStddevRad)) {
    hidden_start.reset();
    return true;
  }
  const double reach_m = kHeldReachM + stddev_m;
  const bool is_hidden = held_view.isHidden(depth, grid, toObject(hidden_start->T_camera_centre), reach_m);
  if (is_first && !is_hidden) {
    hidden_start.reset();
    return false;
  }
  filter.initialise(hidden_start->T_camera_centre);
  likelihood.resetOcclusion();
  status.restart();
  smoother.restart();
  initialising_s = 0.0;
  is_blind = is_hidden;
  is_given = !is_hidden;
  initial_variances.reset();
  if (!is_hidden) {
    initial_variances = hidden_start->variances;
    hidden_start.reset();
  }
  return is_hidden;
}

std::optional<FilterEstimate> ObjectTracker::Implementation::lookPastTheHand(
    const DepthImageView& depth, const SamplingGrid& grid, double dt_s, const std::optional<ControlInput>& control) {
  const bool is_followed = follows_hand && control && control->isFollowed();
  if (!is_blind || is_anywhere || !mayReacquire() || !(hidden_start || is_followed)) return std::nullopt;
  const ProcessStep step(config.process, hidden_start ? 0.0 : dt_s, control, centre_object, 1.0);
  const Pose& before = hidden_start ? hidden_start->T_camera_centre : last_mean.mean;
  const Pose carried = perturb(before, step.controlDisplacement(before));
  const Vector6d variances = hidden_start ? hidden_start->variances : Vector6d(last_mean.covariance.diagonal());
  const double reach_m = std::min(kMostReachM, kHeldReachM + std::sqrt(variances.head<3>().maxCoeff()));
  likelihood.setTakenSurfaces(held_view.nearerReadings(depth, grid, toObject(carried), reach_m));
  if (hidden_start) initial_variances = hidden_start->variances;
  const FilterEstimate estimate = look(dt_s, control);
  const PoseAssessment assessment = assess(estimate);
  const bool is_there = assessment.visibleShare() > kLeastVisibleShare &&
                        assessment.visible_pixels > kLeastVisibleCells &&
                        assessment.achieved > kLeastScore * assessment.expected &&
                        assessment.through_pixels <= kMostThrough * assessment.measured_pixels &&
                        assessment.beyond_pixels >= kLeastBeyond * assessment.surrounding_pixels &&
                        assessment.continued_pixels <= kMostContinued * assessment.surrounding_pixels;
  if (is_there) {
    hidden_start.reset();
    is_blind = false;
    return estimate;
  }
  filter.undo();
  if (hidden_start) likelihood.resetOcclusion();
  return std::nullopt;
}

void ObjectTracker::Implementation::carryGrasp(double dt_s, const std::optional<ControlInput>& control) {
  const bool is_held = control && control->isFollowed();
  if (!mayReacquire() || is_anywhere || !is_held) {
    grasp_memory.forget();
  } else if (is_given && initial_variances) {
    grasp_memory.given(filter.poses().front());
  } else if (grasp_memory.pose()) {
    const ProcessStep step(config.process, dt_s, control, centre_object, 1.0);
    grasp_memory.moved(perturb(*grasp_memory.pose(), step.controlDisplacement(*grasp_memory.pose())));
  }
  reacquisition.expectInHand(grasp_memory.pose());
}

/// What is usual may have been learnt of the hand.
double ObjectTracker::Implementation::scoreInHand() const {
  constexpr double kOfAFairMesh = 0.92;
  return std::max(kOfAFairMesh, reacquisition.usualScore());
}

void ObjectTracker::Implementation::rememberGrasp(const Pose& T_camera_centre, double dt_s) {
  if (!follows_hand) return;
  const bool is_told = status.state() == TrackerState::kTracking && is_seen && !is_hidden_in_hand;
  grasp_memory.seen(T_camera_centre, is_told ? status.score() / scoreInHand() : 0.0, dt_s);
}

bool ObjectTracker::Implementation::returnToGrasp(const DepthImageView& depth, double dt_s,
                                                  const std::optional<ControlInput>& control, FilterEstimate& estimate,
                                                  const PoseAssessment& assessment) {
  if (!follows_hand || hidden_start || is_hidden_in_hand) return false;
  const double score = is_blind ? 0.0 : assessment.achieved / std::max(1e-9, assessment.expected);
  if (!grasp_memory.isDue(estimate.pose.mean, score / scoreInHand())) return false;
  const std::optional<Pose> better =
      reacquisition.findGiven(depth, camera_in_use, estimate.pose.mean, *grasp_memory.pose(), inHandVariances(), 1);
  grasp_memory.compared();
  if (!better) return false;
  estimate = lookInHand(depth, dt_s, control, *better);
  return true;
}

FilterEstimate ObjectTracker::Implementation::lookInHand(const DepthImageView& depth, double dt_s,
                                                         const std::optional<ControlInput>& control,
                                                         const Pose& better) {
  startInHand(better);
  is_back_in_hand = true;
  is_blind = false;
  FilterEstimate estimate = look(dt_s, control);
  if (!leavesForWorse(depth, estimate.pose.mean, better)) return estimate;
  // What hides it draws the filter away: it stays there until more is seen.
  startInHand(better);
  grasp_memory.moved(better);
  initial_variances.reset();
  is_blind = true;
  return hold(dt_s, control);
}

void ObjectTracker::Implementation::startInHand(const Pose& T_camera_centre) {
  startAt(T_camera_centre);
  initial_variances = sampledVariances();
  turn_prior.stddev_rad = std::sqrt(inHandVariances().tail<3>().maxCoeff());
  free_turn.restart(turn_prior.stddev_rad);
}

bool ObjectTracker::Implementation::leavesForWorse(const DepthImageView& depth, const Pose& T_camera_centre,
                                                   const Pose& better) {
  constexpr double kFarM = 0.005, kFarRad = 0.1;
  const Vector6d moved = difference(T_camera_centre, better);
  return (moved.head<3>().norm() > kFarM || moved.tail<3>().norm() > kFarRad) &&
         reacquisition.judge(depth, camera_in_use, T_camera_centre) < reacquisition.judge(depth, camera_in_use, better);
}

void ObjectTracker::Implementation::followHand(const ProcessStep& step, bool follows, double dt_s) {
  const Vector6d before = hand_velocity;
  hand_velocity.setZero();
  if (follows && dt_s > 0.0) hand_velocity = step.controlDisplacement(last_mean.mean) / dt_s;
  if (follows != follows_hand) {
    filter.shiftVelocities(before - hand_velocity);
    slip.reset();
  }
  follows_hand = follows;
}

void ObjectTracker::Implementation::estimateSlip(const FilterEstimate& estimate, double dt_s) {
  result.slip.reset();
  if (!follows_hand || dt_s <= 0.0 || is_blind || !step_in_use) return;
  HandStep in_hand;
  const Pose carried = perturb(last_mean.mean, step_in_use->controlDisplacement(last_mean.mean));
  in_hand.residual = difference(estimate.pose.mean, carried);
  in_hand.pose_variances = estimate.pose.covariance.diagonal();
  in_hand.hand_velocity = hand_velocity;
  in_hand.R_camera_object = estimate.pose.mean.linear();
  in_hand.dt_s = dt_s;
  result.slip = slip.update(in_hand);
  const Eigen::Vector3d origin_from_centre = -(in_hand.R_camera_object * centre_object);
  result.slip->relative_twist.head<3>() += result.slip->relative_twist.tail<3>().cross(origin_from_centre);
  result.slip->covariance = transportCovariance(result.slip->covariance, origin_from_centre);
}

}  // namespace depth_object_tracker
