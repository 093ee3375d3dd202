// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/object_tracker.h"

#include "depth_object_tracker/filter/depth_likelihood.h"
#include "depth_object_tracker/filter/particle_filter.h"
#include "depth_object_tracker/filter/stopwatch.h"
#include "depth_object_tracker/model/slip_estimator.h"
#include "depth_object_tracker/render/depth_renderer.h"
#include "depth_object_tracker/tracker/doubt.h"
#include "depth_object_tracker/tracker/frame_clock.h"
#include "depth_object_tracker/tracker/held_view.h"
#include "depth_object_tracker/tracker/live_parameters.h"
#include "depth_object_tracker/tracker/look_alikes.h"
#include "depth_object_tracker/tracker/pose_search.h"
#include "depth_object_tracker/tracker/reacquisition.h"
#include "depth_object_tracker/tracker/resolution.h"
#include "depth_object_tracker/tracker/status_monitor.h"
#include "depth_object_tracker/tracker/tracker_parameters.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace depth_object_tracker {
namespace {

// Spread of an angle that nothing can be known of.
constexpr double kFreeAngleVariance = M_PI * M_PI / 3.0;

constexpr double kSearchEverywhereAfterS = 3.0;
constexpr double kUsualDistanceM = 0.8;
constexpr double kSettledAfterS = 3.0;
constexpr double kDoubtfulAfterFindS = 0.7, kLongAgoS = 1e6;
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

/// How far from the truth a pose given by hand may be.
Vector6d givenPoseVariances(const Vector6d& initial_variances) {
  constexpr double kPositionM = 0.03, kRotationRad = 0.3;
  Vector6d variances = initial_variances;
  variances.head<3>() = variances.head<3>().cwiseMax(kPositionM * kPositionM);
  variances.tail<3>() = variances.tail<3>().cwiseMax(kRotationRad * kRotationRad);
  return variances;
}

constexpr int kHypotheses = 100;
constexpr double kPoorFitReachS = 0.3;  // as far as after this long unseen
constexpr double kFitsWithinS = 0.3;    // an initial pose, or it is wrong
constexpr int kLeastParticles = 24;     // that a late frame is not cut below
// With less in view than this the image says nothing of the pose but where it is not.
constexpr double kBlindBelowVisibleFraction = 0.04;
// With less of the object in view its pose counts as not seen.
constexpr double kSeenAboveVisibleFraction = 0.3;

// Of an object in a robot's hand: error of the mesh and the sensor, and how fast it may slip.
constexpr double kHeldReachM = 0.004, kHeldSpeedM_s = 0.1;

bool fitsWell(const PoseAssessment& assessment) {
  constexpr double kScore = 0.8;
  return assessment.visibleShare() > kSeenAboveVisibleFraction && assessment.achieved > kScore * assessment.expected;
}

Symmetries aboutCentre(Symmetries symmetries, const Eigen::Vector3d& centre_object) {
  for (SymmetryAxis& axis : symmetries.continuous) axis.offset -= centre_object;
  for (Pose& pose : symmetries.discrete) {
    pose.translation() += pose.linear() * centre_object - centre_object;
  }
  return symmetries;
}

double objectRadius(const TriangleMesh& mesh, const Eigen::Vector3d& centre) {
  double sum = 0.0;
  for (const Eigen::Vector3f& vertex : mesh.vertices) sum += (vertex.cast<double>() - centre).squaredNorm();
  return std::sqrt(sum / static_cast<double>(mesh.vertices.size()));
}

/// Throws when the object cannot be tracked, before anything is built from it.
const ObjectModel& checked(const ObjectModel& object) {
  if (object.mesh.triangles.empty())
    throw std::invalid_argument("object '" + object.name + "' has a mesh without triangles");
  return object;
}

const TrackerConfig& checked(const TrackerConfig& config) {
  validateTrackerConfig(config);
  return config;
}

}  // namespace

class ObjectTracker::Implementation {
 public:
  Implementation(ObjectModel object_model, const TrackerConfig& tracker_config)
      : object(std::move(object_model)),
        config(checked(tracker_config)),
        centre_object(surfaceCentroid(checked(object).mesh)),
        diameter_m(diameter(object.mesh)),
        shape(object.mesh, centre_object),
        pool(std::make_shared<WorkerPool>(config.filter.num_threads)),
        likelihood(shape, config.pixel, config.occlusion, config.filter.num_particles, pool),
        filter(config.filter, objectRadius(object.mesh, centre_object), aboutCentre(object.symmetries, centre_object)),
        symmetries(aboutCentre(object.symmetries, centre_object)),
        resolution(config.resolution),
        status(config.status),
        slip(config.slip),
        search(config.filter.seed),
        held_view(object.mesh),
        look_alikes(findLookAlikes(object.mesh, centre_object, aboutCentre(object.symmetries, centre_object))),
        reacquisition(
            std::make_unique<PoseFinder>(shape, object.mesh, diameter_m, config.pixel, config.filter.seed, pool)) {}

  TrackerResult update(const DepthImageView& depth, const PinholeCamera& camera, double stamp_s,
                       const std::optional<ControlInput>& control, KnownOccluders* occluders);

  Pose toObject(const Pose& T_camera_centre) const {
    Pose T_camera_object = T_camera_centre;
    T_camera_object.translation() -= T_camera_centre.linear() * centre_object;
    return T_camera_object;
  }
  Pose toCentre(const Pose& T_camera_object) const { return T_camera_object * Eigen::Translation3d(centre_object); }

  ObjectModel object;
  TrackerConfig config;
  Eigen::Vector3d centre_object;
  double diameter_m;
  ObjectShape shape;
  std::shared_ptr<WorkerPool> pool;
  DepthLikelihood likelihood;
  ParticleFilter filter;
  Symmetries symmetries;  // about the centre
  ResolutionChooser resolution;
  StatusMonitor status;
  SlipEstimator slip;
  CovarianceCalibration calibration;
  PoseSearch search;
  HeldView held_view;
  Hypotheses hypotheses;  // of this image
  LookAlikeCheck look_alikes;
  Reacquisition reacquisition;
  double unseen_s = 0.0;       // since the object was last seen well
  PoseStatistics last_mean;    // of the centre
  bool is_anywhere = false;    // nothing is known of the pose yet
  bool is_on_table = false;    // but that the object rests on a plane
  bool is_blind = false;       // nothing of the object was seen in the last image, or not where it was thought to be
  double moved_s = kLongAgoS;  // since the filter was started anew, at a pose that was searched
  double reacquired_s = kLongAgoS;  // since the object was found again
  Doubt doubt;
  double since_learnt_s = kLongAgoS;       // how well the object fits where it is seen
  double initialising_s = 0.0;             // since an initial pose that does not fit yet
  std::optional<ProcessStep> step_in_use;  // of the last image that was looked at
  bool follows_hand = false;
  bool is_hidden_in_hand = false;  // most of it, in this image: the robot's motion says more than what little is seen
  Vector6d hand_velocity = Vector6d::Zero();  // of the centre as the robot has it; zero when it is not followed
  FrameClock clock;
  bool is_given = false;                      // the pose, since the last image, by hand or by a robot
  std::vector<Pose> around_given;             // at which the object may be instead
  std::optional<Vector6d> initial_variances;  // set by initialise, used by the next image
  double full_resolution_pixels = 0.0;        // that the object covers
  double effort = 1.0;                        // of what is configured
  KnownOccluders* known_occluders = nullptr;  // during an update
  PinholeCamera camera_in_use;
  TrackerResult result;

 private:
  bool checkInput(const DepthImageView& depth, const PinholeCamera& camera, double stamp_s);
  FrameClock::Step advanceClock(double stamp_s);
  /// What hides most of an object in a robot's hand is not taken for it.
  void setAsideWhatIsNotHeld(const DepthImageView& depth, const SamplingGrid& grid, double dt_s,
                             const std::optional<ControlInput>& control);
  double projectedPixels(const PinholeCamera& camera) const;
  double diffusionScale() const;
  /// The covariance as the image bears it out.
  void calibrate(FilterEstimate& estimate, double dt_s);
  /// The process into this image, and poses to look at besides: at the start, while little is seen, after a loss.
  ProcessStep makeStep(double dt_s, const std::optional<ControlInput>& control);
  /// One frame of the filter.
  FilterEstimate look(double dt_s, const std::optional<ControlInput>& control);
  /// One frame without a measurement.
  FilterEstimate hold(double dt_s, const std::optional<ControlInput>& control);
  PoseAssessment assess(const FilterEstimate& estimate);
  bool seesNothing(const PoseAssessment& assessment) const;
  /// The paper's filter neither searches nor holds.
  bool mayReacquire() const { return config.filter.proposal == Proposal::kInformed; }
  /// Starts the filter anew where the object is seen. @return false when it is not.
  bool reacquire(const DepthImageView& depth, double dt_s);
  /// The estimate may be at a neighbouring mode: the image does not fit well, or the object was only just found.
  Doubt::Look whereToLook() const;
  bool moveToBetterPose(const DepthImageView& depth, const Pose& T_camera_centre);
  void startAt(const Pose& T_camera_centre);
  /// Moves to a pose that looks alike but explains the image better.
  void turnToLookAlike(FilterEstimate& estimate, PoseAssessment& assessment, double dt_s);
  /// Particles' velocities are relative to the hand while it is followed: hand over at grasp and release.
  void followHand(const ProcessStep& step, bool follows, double dt_s);
  void estimateSlip(const FilterEstimate& estimate, double dt_s);
  void rememberFit(const FilterEstimate& estimate, double dt_s);
  /// From time to time, where the object is surely seen.
  void learnFit(const DepthImageView& depth, double dt_s);
  void writeEstimate(const FilterEstimate& estimate);
  void writeStatus(const PoseAssessment& assessment);
};

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
  setAsideWhatIsNotHeld(depth, grid, time.dt_s, control);

  if (is_blind && reacquire(depth, time.dt_s)) is_blind = false;
  const bool was_given = is_given && initial_variances && mayReacquire();
  const Vector6d given_variances = initial_variances.value_or(Vector6d::Zero());
  const Pose given = filter.poses().front();
  is_given = false;
  FilterEstimate estimate = is_blind ? hold(time.dt_s, control) : look(time.dt_s, control);
  PoseAssessment assessment = assess(estimate);
  if (was_given && !fitsWell(assessment)) {
    // Perhaps it is farther from the truth than its variances say.
    filter.initialise(given);
    likelihood.resetOcclusion();
    initial_variances = given_variances;
    around_given = reacquisition.lookAround(depth, camera, given, givenPoseVariances(given_variances));
    estimate = look(time.dt_s, control);
    assessment = assess(estimate);
  }
  if (!is_blind && seesNothing(assessment)) {
    // The update is not to be trusted: what was seen is not the object.
    filter.undo();
    filter.stopMotion();
    is_blind = true;
    estimate = hold(time.dt_s, control);
    assessment = assess(estimate);
  } else if (!is_blind && moveToBetterPose(depth, estimate.pose.mean)) {
    estimate = look(time.dt_s, control);
    assessment = assess(estimate);
  }
  turnToLookAlike(estimate, assessment, time.dt_s);
  calibrate(estimate, time.dt_s);
  full_resolution_pixels = assessment.covered_pixels * static_cast<double>(grid.factor * grid.factor);
  status.update(assessment, time.dt_s, is_blind);
  result.grasped = control && control->grasped;
  result.downsampling = grid.factor;
  writeEstimate(estimate);
  writeStatus(assessment);
  estimateSlip(estimate, time.dt_s);
  rememberFit(estimate, time.dt_s);
  learnFit(depth, time.dt_s);
  result.time.total_s = stopwatch.lap();
  return result;
}

FilterEstimate ObjectTracker::Implementation::look(double dt_s, const std::optional<ControlInput>& control) {
  const ProcessStep step = makeStep(dt_s, control);
  step_in_use = step;
  const double exponent = likelihoodExponent(config.filter, likelihood.image().grid().factor);
  return filter.update(likelihood, step, exponent, hypotheses);
}

FilterEstimate ObjectTracker::Implementation::hold(double dt_s, const std::optional<ControlInput>& control) {
  ProcessStep step(config.process, dt_s, control, centre_object, diffusionScale(), slip.noiseScale());
  step.excludeSuddenMotion();
  followHand(step, control && control->isFollowed(), dt_s);
  return filter.hold(likelihood, step);
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
  if (camera != camera_in_use) full_resolution_pixels = 0.0;
  camera_in_use = camera;
  if (status.state() == TrackerState::kUninitialized) result.reason = "no initial pose was given yet";
  return true;
}

void ObjectTracker::Implementation::setAsideWhatIsNotHeld(const DepthImageView& depth, const SamplingGrid& grid,
                                                          double dt_s, const std::optional<ControlInput>& control) {
  const bool was_hidden = is_hidden_in_hand;
  is_hidden_in_hand = false;
  if (!follows_hand || is_blind || initial_variances || !control || !control->isFollowed() || !mayReacquire()) {
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
    is_blind = is_anywhere;
    if (!is_anywhere) initial_variances = defaultInitialVariances(config.initialisation);
  }
  return time;
}

ProcessStep ObjectTracker::Implementation::makeStep(double dt_s, const std::optional<ControlInput>& control) {
  hypotheses.always.clear();
  hypotheses.if_poor.clear();
  if (initial_variances) {
    const ProcessStep step(config.process, *initial_variances);
    if (mayReacquire()) search.around(filter.poses().front(), *initial_variances, kHypotheses, hypotheses.always);
    hypotheses.always.insert(hypotheses.always.end(), around_given.begin(), around_given.end());
    around_given.clear();
    initial_variances.reset();
    return step;
  }
  ProcessStep step(config.process, dt_s, control, centre_object, diffusionScale(),
                   is_hidden_in_hand ? config.process.hidden_diffusion_scale : slip.noiseScale());
  if (is_hidden_in_hand) step.excludeSuddenMotion();
  followHand(step, control && control->isFollowed(), dt_s);
  if (mayReacquire() && !is_hidden_in_hand) {
    search.around(last_mean.mean, searchVariances(kPoorFitReachS), kHypotheses, hypotheses.if_poor);
  }
  return step;
}

bool ObjectTracker::Implementation::reacquire(const DepthImageView& depth, double dt_s) {
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

void ObjectTracker::Implementation::rememberFit(const FilterEstimate& estimate, double dt_s) {
  const bool seen = status.state() == TrackerState::kTracking && !status.misfit() &&
                    status.visibleFraction() >= kSeenAboveVisibleFraction;
  unseen_s = seen ? 0.0 : unseen_s + dt_s;
  reacquired_s += dt_s;
  // A pose that had to be searched is not one that was followed.
  moved_s = status.state() == TrackerState::kInitializing ? 0.0 : moved_s + dt_s;
  last_mean = estimate.pose;
  doubt.update(status.score() / reacquisition.usualScore(), status.visibleFraction(), seen, dt_s);
  initialising_s = status.state() == TrackerState::kInitializing ? initialising_s + dt_s : 0.0;
  const bool may_be_blind =
      mayReacquire() && (status.state() != TrackerState::kInitializing || initialising_s > kFitsWithinS);
  const bool nothing_seen = status.visibleFraction() < kBlindBelowVisibleFraction || status.misfit();
  const bool never_fitted = status.state() == TrackerState::kInitializing && initialising_s > kFitsWithinS;
  const bool lost = status.state() == TrackerState::kLost;
  is_blind = is_anywhere || (may_be_blind && (is_blind || nothing_seen || never_fitted || lost));
}

void ObjectTracker::Implementation::learnFit(const DepthImageView& depth, double dt_s) {
  constexpr double kEveryS = 0.5, kSureAfterS = 1.0;
  since_learnt_s += dt_s;
  if (!mayReacquire() || unseen_s > 0.0 || moved_s < kSureAfterS || since_learnt_s < kEveryS) return;
  since_learnt_s = 0.0;
  reacquisition.learn(depth, camera_in_use, last_mean.mean);
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

void ObjectTracker::Implementation::writeEstimate(const FilterEstimate& estimate) {
  const Eigen::Matrix3d R = estimate.pose.mean.linear();
  const Eigen::Vector3d origin_from_centre = -(R * centre_object);
  Matrix6d covariance = estimate.pose.covariance;
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
  result.reason = status.reason();
  result.visible_fraction = status.visibleFraction();
  result.score = status.state() == TrackerState::kLost ? 0.0 : status.score();
  result.log_likelihood = assessment.log_likelihood;
  result.pixels = assessment.covered_pixels;
  result.valid_pixel_fraction = likelihood.image().validFraction();
}

ObjectTracker::ObjectTracker(ObjectModel object, const TrackerConfig& config)
    : implementation_(std::make_unique<Implementation>(std::move(object), config)) {}
ObjectTracker::~ObjectTracker() = default;
ObjectTracker::ObjectTracker(ObjectTracker&&) noexcept = default;
ObjectTracker& ObjectTracker::operator=(ObjectTracker&&) noexcept = default;

void ObjectTracker::initialise(const Pose& T_camera_object, const Matrix6d& covariance) {
  Implementation& self = *implementation_;
  const Pose T_camera_centre = self.toCentre(T_camera_object);
  self.initial_variances = defaultInitialVariances(self.config.initialisation);
  if (covariance.diagonal().cwiseAbs().maxCoeff() > 0.0) {
    const Eigen::Vector3d centre_from_origin = T_camera_object.linear() * self.centre_object;
    self.initial_variances = transportCovariance(covariance, centre_from_origin).diagonal();
  }
  self.is_given = true;
  self.around_given.clear();
  self.filter.initialise(T_camera_centre);
  self.last_mean = PoseStatistics();
  self.last_mean.mean = T_camera_centre;
  self.unseen_s = 0.0;
  self.doubt.restart();
  self.initialising_s = 0.0;
  self.is_blind = self.is_anywhere = self.is_on_table = false;
  self.reacquired_s = self.moved_s = kLongAgoS;
  self.calibration.restart();
  self.look_alikes.restart();
  self.reacquisition.restart();
  self.follows_hand = false;
  self.slip.reset();
  self.hand_velocity.setZero();
  self.likelihood.resetOcclusion();
  self.clock.reset();
  self.status.restart();
  self.resolution.reset();
  self.full_resolution_pixels = 0.0;
  self.result = TrackerResult();
  self.result.state = self.status.state();
  self.result.reason = self.status.reason();
}

void ObjectTracker::initialiseAnywhere() {
  Implementation& self = *implementation_;
  Pose T_camera_object = Pose::Identity();
  T_camera_object.translation().z() = kUsualDistanceM;
  initialise(T_camera_object);
  self.initial_variances.reset();
  self.is_given = false;
  self.is_blind = self.is_anywhere = true;
  self.result.reason = self.status.reason();
}

void ObjectTracker::initialiseOnTable() {
  initialiseAnywhere();
  implementation_->is_on_table = true;
}

std::optional<ImagePlane> ObjectTracker::table() const {
  return implementation_->reacquisition.table();
}

void ObjectTracker::reset() {
  implementation_->status.reset();
  implementation_->result = TrackerResult();
}

void ObjectTracker::moveCamera(const Pose& T_now_before) {
  Implementation& self = *implementation_;
  const Eigen::Matrix3d R_now_before = T_now_before.linear();
  self.filter.moveCamera(T_now_before);
  self.hand_velocity = rotated(self.hand_velocity, R_now_before);
  self.last_mean.mean = T_now_before * self.last_mean.mean;
  self.last_mean.covariance = rotated(self.last_mean.covariance, R_now_before);
  self.result.T_camera_object = T_now_before * self.result.T_camera_object;
  self.result.covariance = rotated(self.result.covariance, R_now_before);
  self.result.twist = rotated(self.result.twist, R_now_before);
  self.result.twist_covariance = rotated(self.result.twist_covariance, R_now_before);
}

void ObjectTracker::setEffort(double effort) {
  Implementation& self = *implementation_;
  self.effort = std::clamp(effort, 1e-3, 1.0);
  const int wanted = static_cast<int>(std::lround(std::sqrt(self.effort) * self.config.filter.num_particles));
  self.filter.setNumParticles(std::max({1, wanted, std::min(kLeastParticles, self.config.filter.num_particles)}));
}

void ObjectTracker::setLiveParameters(const TrackerConfig& changed) {
  Implementation& self = *implementation_;
  self.config = withLiveParameters(self.config, changed);
  self.status.setConfig(self.config.status);
  self.resolution.setConfig(self.config.resolution);
  setEffort(self.effort);
}

TrackerResult ObjectTracker::update(const DepthImageView& depth, const PinholeCamera& camera, double stamp_s,
                                    const std::optional<ControlInput>& control, KnownOccluders* occluders) {
  return implementation_->update(depth, camera, stamp_s, control, occluders);
}

ParticlePoses ObjectTracker::particles() const {
  ParticlePoses particles;
  if (!implementation_->result.has_pose) return particles;
  for (const Pose& pose : implementation_->filter.poses())
    particles.T_camera_object.push_back(implementation_->toObject(pose));
  for (double weight : implementation_->filter.weights()) particles.weights.push_back(static_cast<float>(weight));
  return particles;
}

OcclusionMap ObjectTracker::occlusionMap() const {
  OcclusionMap map;
  if (!implementation_->result.has_pose) return map;
  map.grid = implementation_->likelihood.image().grid();
  implementation_->likelihood.occlusionMap(implementation_->filter.poses(), implementation_->filter.weights(),
                                           map.p_occluded);
  return map;
}

std::vector<float> ObjectTracker::renderEstimate() const {
  const PinholeCamera& camera = implementation_->camera_in_use;
  std::vector<float> depth(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height), 0.0f);
  if (!implementation_->result.has_pose) return depth;
  DepthRenderer renderer(implementation_->object.mesh);
  for (const CoveredPixel& pixel : renderer.render(implementation_->result.T_camera_object, camera)) {
    depth[static_cast<std::size_t>(pixel.row) * static_cast<std::size_t>(camera.width) + pixel.col] = pixel.depth;
  }
  return depth;
}

const ObjectModel& ObjectTracker::object() const {
  return implementation_->object;
}
const TrackerConfig& ObjectTracker::config() const {
  return implementation_->config;
}
double ObjectTracker::diameterM() const {
  return implementation_->diameter_m;
}

}  // namespace depth_object_tracker
