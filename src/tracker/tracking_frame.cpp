// SPDX-License-Identifier: BSD-3-Clause
#include "tracker/tracker_implementation.h"

#include "depth_object_tracker/filter/stopwatch.h"
#include "depth_object_tracker/render/depth_renderer.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace depth_object_tracker {
namespace {

// Spread of an angle that nothing can be known of.
constexpr double kFreeAngleVariance = M_PI * M_PI / 3.0;

constexpr int kHypotheses = 100;
constexpr double kPoorFitReachS = 0.3;  // as far as after this long unseen
constexpr double kFitsWithinS = 0.3;    // an initial pose, or it is wrong

// With less in view than this the image says nothing of the pose but where it is not.
constexpr double kBlindBelowVisibleFraction = 0.04;

}  // namespace

TrackerResult ObjectTracker::Implementation::update(const DepthImageView& depth, const PinholeCamera& camera,
                                                    double stamp_s, const std::optional<ControlInput>& control,
                                                    KnownOccluders* occluders) {
  Stopwatch stopwatch;
  if (!checkInput(depth, camera, stamp_s)) return result;
  if (status.state() == TrackerState::kUninitialized) return result;
  const FrameClock::Step time = advanceClock(stamp_s);
  if (time.event == FrameClock::Event::kDuplicate) return result;

  if (full_resolution_pixels <= 0.0) full_resolution_pixels = projectedPixels(camera);
  const SamplingGrid grid = makeSamplingGrid(camera, resolution.choose(full_resolution_pixels, std::sqrt(effort)));
  likelihood.setImage(depth, grid, time.dt_s);
  known_occluders = config.pixel.known_occluder_p_occluded > 0.0 ? occluders : nullptr;
  if (known_occluders != nullptr) {
    likelihood.setOccluders(known_occluders->render(grid.camera));
    likelihood.setTakenSurfaces(known_occluders->renderSeen(grid.camera));
  }
  if (!is_anywhere) likelihood.weighMissingReadings(last_mean.mean);
  carryGrasp(time.dt_s, control);
  setAsideWhatIsNotHeld(depth, grid, time.dt_s, control);

  const std::optional<FilterEstimate> past_hand = lookPastTheHand(depth, grid, time.dt_s, control);
  if (is_blind && reacquire(depth, time.dt_s)) is_blind = false;
  const bool was_given = is_given && initial_variances && mayReacquire();
  const Vector6d given_variances = initial_variances.value_or(Vector6d::Zero());
  const Pose given = filter.poses().front();
  is_given = false;
  FilterEstimate estimate = past_hand ? *past_hand : is_blind ? hold(time.dt_s, control) : look(time.dt_s, control);
  PoseAssessment assessment = assess(estimate);
  if (was_given && !is_blind) startFromGiven(depth, time.dt_s, control, {given, given_variances}, estimate, assessment);
  if (!is_blind && (seesNothing(assessment) || (!past_hand && leaps(depth, estimate)))) {
    // The update is not to be trusted: what was seen is not the object.
    filter.undo();
    filter.stopMotion();
    is_blind = true;
    estimate = hold(time.dt_s, control);
    assessment = assess(estimate);
  } else if (!is_blind && moveToBetterPose(depth, estimate.pose.mean, time.dt_s)) {
    estimate = is_blind ? hold(time.dt_s, control) : look(time.dt_s, control);
    assessment = assess(estimate);
  }
  if (returnToGrasp(depth, time.dt_s, control, estimate, assessment)) assessment = assess(estimate);
  turnToLookAlike(estimate, assessment, time.dt_s);
  turnToMiddle(estimate, assessment, time.dt_s);
  calibrate(estimate, time.dt_s);
  full_resolution_pixels = assessment.covered_pixels * static_cast<double>(grid.factor * grid.factor);
  status.update(assessment, time.dt_s, is_blind);
  result.grasped = control && control->grasped;
  result.downsampling = grid.factor;
  writeEstimate(smoothed(estimate, time.dt_s));
  writeStatus(assessment);
  estimateSlip(estimate, time.dt_s);
  rememberFit(estimate, time.dt_s);
  rememberGrasp(estimate.pose.mean, time.dt_s);
  learnFit(depth, time.dt_s);
  result.time.total_s = stopwatch.lap();
  return result;
}

FilterEstimate ObjectTracker::Implementation::look(double dt_s, const std::optional<ControlInput>& control) {
  const ProcessStep step = makeStep(dt_s, control);
  is_back_in_hand = false;
  step_in_use = step;
  const double exponent = likelihoodExponent(config.filter, likelihood.image().grid().factor);
  return filter.update(likelihood, step, exponent, hypotheses);
}

FilterEstimate ObjectTracker::Implementation::hold(double dt_s, const std::optional<ControlInput>& control) {
  if (hidden_start) return filter.hold(likelihood, ProcessStep(config.process, hidden_start->variances));
  ProcessStep step(config.process, dt_s, control, centre_object, diffusionScale(), slip.noiseScale());
  step.excludeSuddenMotion();
  followHand(step, control && control->isFollowed(), dt_s);
  return filter.hold(likelihood, step);
}

bool ObjectTracker::Implementation::fits(const PoseAssessment& assessment) {
  constexpr double kScore = 0.8;
  return assessment.visibleShare() > kSeenAboveVisibleFraction && assessment.achieved > kScore * assessment.expected;
}

PoseAssessment ObjectTracker::Implementation::assess(const FilterEstimate& estimate) {
  likelihood.setWeights(filter.weights());
  return likelihood.assess(estimate.pose.mean, 0);
}

bool ObjectTracker::Implementation::seesNothing(const PoseAssessment& assessment) const {
  const bool was_seen = status.state() == TrackerState::kTracking || status.state() == TrackerState::kOccluded;
  return mayReacquire() && was_seen && assessment.measured_pixels > 0 &&
         assessment.visibleShare() < kBlindBelowVisibleFraction;
}

bool ObjectTracker::Implementation::checkInput(const DepthImageView& depth, const PinholeCamera& camera,
                                               double stamp_s) {
  std::string problem = camera.findProblem();
  const std::size_t pixel_size = depth.pixel_type == DepthImageView::PixelType::kUint16 ? 2 : 4;
  if (problem.empty() && (depth.data == nullptr || depth.width != camera.width || depth.height != camera.height)) {
    problem = "depth image is " + std::to_string(depth.width) + "x" + std::to_string(depth.height) +
              " but the camera model is " + std::to_string(camera.width) + "x" + std::to_string(camera.height);
  } else if (problem.empty() && depth.step < static_cast<std::size_t>(depth.width) * pixel_size) {
    problem = "depth image has " + std::to_string(depth.step) + " bytes a row, too few for " +
              std::to_string(depth.width) + " pixels";
  } else if (problem.empty() && !std::isfinite(stamp_s)) {
    problem = "image stamp is not finite";
  }
  result.stamp_s = stamp_s;
  result.state = status.state();
  result.input = problem.empty() ? TrackerResult::Input::kUsed : TrackerResult::Input::kUnusable;
  if (!problem.empty()) {
    result.reason = problem;
    return false;
  }
  if (camera != camera_in_use) {
    full_resolution_pixels = 0.0;
    reacquisition.expectImages(camera);
  }
  camera_in_use = camera;
  if (status.state() == TrackerState::kUninitialized) result.reason = "no initial pose was given yet";
  return true;
}

double ObjectTracker::Implementation::projectedPixels(const PinholeCamera& camera) const {
  constexpr int kCoarse = 4;
  DepthRenderer renderer(object.mesh);
  const auto& covered = renderer.render(toObject(filter.poses().front()), makeSamplingGrid(camera, kCoarse).camera);
  return static_cast<double>(covered.size()) * kCoarse * kCoarse;
}

FrameClock::Step ObjectTracker::Implementation::advanceClock(double stamp_s) {
  const FrameClock::Step time = clock.advance(stamp_s);
  if (time.event == FrameClock::Event::kDuplicate) {
    result.input = TrackerResult::Input::kDuplicateStamp;
  } else if (time.event == FrameClock::Event::kBackward) {
    result.input = TrackerResult::Input::kTimeJumpedBack;
    likelihood.resetOcclusion();
    filter.stopMotion();
    status.restart();
    smoother.restart();
    since_fitted_s = kLongAgoS;
    is_blind = is_anywhere;
    if (!is_anywhere) initial_variances = defaultInitialVariances(config.initialisation);
  }
  return time;
}

ProcessStep ObjectTracker::Implementation::makeStep(double dt_s, const std::optional<ControlInput>& control) {
  hypotheses.always.clear();
  hypotheses.if_poor.clear();
  if (initial_variances) {
    ProcessStep step(config.process, *initial_variances);
    if (mayReacquire() && !is_back_in_hand) {
      search.around(filter.poses().front(), *initial_variances, kHypotheses, hypotheses.always);
    }
    hypotheses.always.insert(hypotheses.always.end(), around_given.begin(), around_given.end());
    around_given.clear();
    initial_variances.reset();
    return step;
  }
  ProcessStep step(config.process, dt_s, control, centre_object, diffusionScale(),
                   is_hidden_in_hand ? config.process.hidden_diffusion_scale : slip.noiseScale());
  if (is_hidden_in_hand) step.excludeSuddenMotion();
  followHand(step, control && control->isFollowed(), dt_s);
  if (mayReacquire() && !is_hidden_in_hand && doubt.mayHaveJumped()) {
    search.around(last_mean.mean, searchVariances(kPoorFitReachS), kHypotheses, hypotheses.if_poor);
  }
  return step;
}

void ObjectTracker::Implementation::rememberFit(const FilterEstimate& estimate, double dt_s) {
  const bool seen = status.state() == TrackerState::kTracking && !status.misfit() &&
                    status.visibleFraction() >= kSeenAboveVisibleFraction;
  is_seen = seen;
  unseen_s = seen ? 0.0 : unseen_s + dt_s;
  seen_s = seen ? seen_s + dt_s : 0.0;
  reacquired_s += dt_s;
  since_check_s += dt_s;
  since_sure_s += dt_s;
  since_remembered_s += dt_s;
  // A pose that had to be searched is not one that was followed.
  moved_s = status.state() == TrackerState::kInitializing ? 0.0 : moved_s + dt_s;
  last_mean = estimate.pose;
  last_velocity = estimate.velocity;
  constexpr double kSurelyAfterS = 1.0;  // what was only just found may be something else
  if (seen && moved_s > kSurelyAfterS) seen_distance_m = estimate.pose.mean.translation().z();
  if (seen) seen_velocity = estimate.velocity + hand_velocity;
  doubt.update(status.score() / reacquisition.usualScore(), status.visibleFraction(), seen, dt_s);
  since_fitted_s += dt_s;
  if (seen && !doubt.isPoor()) {
    fitted_pose = estimate.pose.mean;
    since_fitted_s = 0.0;
  }
  initialising_s = status.state() == TrackerState::kInitializing ? initialising_s + dt_s : 0.0;
  const bool may_be_blind =
      mayReacquire() && (status.state() != TrackerState::kInitializing || initialising_s > kFitsWithinS);
  const bool nothing_seen = status.visibleFraction() < kBlindBelowVisibleFraction || status.misfit();
  const bool never_fitted = status.state() == TrackerState::kInitializing && initialising_s > kFitsWithinS;
  const bool lost = status.state() == TrackerState::kLost;
  is_blind = is_anywhere || waitsInHand() || (may_be_blind && (is_blind || nothing_seen || never_fitted || lost));
}

void ObjectTracker::Implementation::calibrate(FilterEstimate& estimate, double dt_s) {
  if (is_blind || !mayReacquire() || !step_in_use) return;
  const double exponent = likelihoodExponent(config.filter, likelihood.image().grid().factor);
  estimate.pose.covariance =
      calibration.calibrated(estimate.pose.covariance, likelihood.scatterOfScores(estimate.pose.mean, 0), exponent,
                             step_in_use->component(0).variances, shape.radius_m, dt_s);
}

double ObjectTracker::Implementation::diffusionScale() const {
  const double seen = config.process.diffusion_full_above_visible_fraction;
  if (seen <= 0.0 || status.visibleFraction() >= seen) return 1.0;
  const double share = status.visibleFraction() / seen;
  return config.process.hidden_diffusion_scale + (1.0 - config.process.hidden_diffusion_scale) * share;
}

FilterEstimate ObjectTracker::Implementation::smoothed(FilterEstimate estimate, double dt_s) {
  if (!config.filter.smooth_estimate || is_blind || status.state() != TrackerState::kTracking) {
    smoother.restart();
    return estimate;
  }
  estimate.pose.mean = smoother.update(estimate.pose.mean, estimate.pose.covariance, dt_s);
  const Matrix6d covariance = smoother.velocityCovariance();
  if (covariance.trace() < estimate.velocity_covariance.trace()) {  // else it has only just started
    estimate.velocity = smoother.velocity() - hand_velocity;        // to be added to it
    estimate.velocity_covariance = covariance;
  }
  return estimate;
}

void ObjectTracker::Implementation::writeEstimate(const FilterEstimate& estimate) {
  const Eigen::Matrix3d R = estimate.pose.mean.linear();
  const Eigen::Vector3d origin_from_centre = -(R * centre_object);
  Matrix6d covariance = estimate.pose.covariance;
  // Particles are held together while nothing is seen, to be near when it is again.
  const bool may_go_anywhere = is_blind && mayReacquire() && !follows_hand;
  if (may_go_anywhere) covariance.diagonal() += hiddenVariances(seen_velocity, unseen_s);
  if (!is_blind && mayReacquire()) covariance = free_turn.widened(covariance, estimate.pose.mean);
  if (const auto axis = freeAxisInCamera(estimate.pose.mean, symmetries)) {
    covariance.bottomRightCorner<3, 3>() += kFreeAngleVariance * (*axis) * axis->transpose();
  }
  result.has_pose = !is_anywhere;
  result.T_camera_object = toObject(estimate.pose.mean);
  result.covariance = transportCovariance(covariance, origin_from_centre);
  result.twist = estimate.velocity + hand_velocity;
  result.twist.head<3>() += result.twist.tail<3>().cross(origin_from_centre);
  result.twist_covariance = transportCovariance(estimate.velocity_covariance, origin_from_centre);
  result.effective_sample_size = estimate.effective_sample_size;
  result.num_particles = static_cast<int>(filter.poses().size());
  result.pose_evaluations = estimate.pose_evaluations;
  result.time.proposal_s = estimate.time.proposal_s;
  result.time.render_likelihood_s = estimate.time.likelihood_s;
  result.time.resample_s = estimate.time.resample_s;
}

void ObjectTracker::Implementation::writeStatus(const PoseAssessment& assessment) {
  result.state = status.state();
  result.reason = hidden_start || waitsInHand() ? "something hides the object: following the hand until it is seen"
                                                : status.reason();
  result.visible_fraction = status.visibleFraction();
  result.score = status.state() == TrackerState::kLost ? 0.0 : status.score();
  result.log_likelihood = assessment.log_likelihood;
  result.pixels = assessment.covered_pixels;
  result.valid_pixel_fraction = likelihood.image().validFraction();
}

}  // namespace depth_object_tracker
