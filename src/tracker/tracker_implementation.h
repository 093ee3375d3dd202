// SPDX-License-Identifier: BSD-3-Clause
// What an ObjectTracker is made of, and the steps of a frame. Three files: the frame itself (tracking_frame.cpp), other
// poses that the object may be at (tracking_search.cpp), an object in a robot's hand (tracking_held.cpp).
#pragma once

#include "depth_object_tracker/filter/depth_likelihood.h"
#include "depth_object_tracker/filter/particle_filter.h"
#include "depth_object_tracker/filter/pose_smoother.h"
#include "depth_object_tracker/model/slip_estimator.h"
#include "depth_object_tracker/tracker/doubt.h"
#include "depth_object_tracker/tracker/frame_clock.h"
#include "depth_object_tracker/tracker/free_turn.h"
#include "depth_object_tracker/tracker/grasp_memory.h"
#include "depth_object_tracker/tracker/held_view.h"
#include "depth_object_tracker/tracker/look_alike_check.h"
#include "depth_object_tracker/tracker/object_tracker.h"
#include "depth_object_tracker/tracker/pose_search.h"
#include "depth_object_tracker/tracker/reacquisition.h"
#include "depth_object_tracker/tracker/resolution.h"
#include "depth_object_tracker/tracker/status_monitor.h"

#include <memory>
#include <optional>
#include <vector>

namespace depth_object_tracker {

class ObjectTracker::Implementation {
 public:
  /// Throws std::invalid_argument when the object or the configuration cannot be used.
  Implementation(ObjectModel object_model, const TrackerConfig& tracker_config);

  TrackerResult update(const DepthImageView& depth, const PinholeCamera& camera, double stamp_s,
                       const std::optional<ControlInput>& control, KnownOccluders* occluders);

  Pose toObject(const Pose& T_camera_centre) const {
    Pose T_camera_object = T_camera_centre;
    T_camera_object.translation() -= T_camera_centre.linear() * centre_object;
    return T_camera_object;
  }
  Pose toCentre(const Pose& T_camera_object) const { return T_camera_object * Eigen::Translation3d(centre_object); }

  static constexpr double kLongAgoS = 1e6;
  // With less of the object in view its pose counts as not seen.
  static constexpr double kSeenAboveVisibleFraction = 0.3;

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
  PoseSmoother smoother;
  PoseSearch search;
  HeldView held_view;
  GraspMemory grasp_memory;
  struct HiddenStart {
    Pose T_camera_centre;
    Vector6d variances;
  };
  std::optional<HiddenStart> hidden_start;  // an initial pose of which nothing was seen yet, carried by the hand
  Hypotheses hypotheses;                    // of this image
  LookAlikeCheck look_alikes;
  FreeTurn free_turn;
  TurnPrior turn_prior;  // of an estimate that was found
  Reacquisition reacquisition;
  bool is_seen = false;                       // well, in the last image
  double seen_s = 0.0;                        // for how long, without a break
  double unseen_s = 0.0;                      // since the object was last seen well
  PoseStatistics last_mean;                   // of the centre
  Vector6d last_velocity = Vector6d::Zero();  // as particles' velocities are
  double seen_distance_m = 0.0;               // of the centre, when the object was last surely seen
  Vector6d seen_velocity = Vector6d::Zero();  // of the centre, when the object was last seen well
  Pose fitted_pose = Pose::Identity();        // of the centre, when it was last seen where it was expected, and fitted
  double since_fitted_s = kLongAgoS;
  bool is_anywhere = false;    // nothing is known of the pose yet
  bool is_on_table = false;    // but that the object rests on a plane
  bool is_blind = false;       // nothing of the object was seen in the last image, or not where it was thought to be
  double moved_s = kLongAgoS;  // since the filter was started anew, at a pose that was searched
  double reacquired_s = kLongAgoS;   // since the object was found again
  double since_check_s = kLongAgoS;  // since its pose was compared with others
  double since_sure_s = kLongAgoS;   // since the pose was surely the object's
  Doubt doubt;
  /// What was known before the object was found, should it turn out to be something else.
  struct BeforeFind {
    PoseStatistics mean;
    Vector6d seen_velocity;
    double unseen_s, since_sure_s;
    TrackerState state;
    int contradictions = 0;  // in a row
  };
  std::optional<BeforeFind> before_find;
  double since_remembered_s = kLongAgoS;   // all that is in view
  double since_learnt_s = kLongAgoS;       // how well the object fits where it is seen
  double initialising_s = 0.0;             // since an initial pose that does not fit yet
  std::optional<ProcessStep> step_in_use;  // of the last image that was looked at
  bool follows_hand = false;
  bool is_back_in_hand = false;    // the filter starts where the hand should have the object, and looks nowhere else
  bool is_hidden_in_hand = false;  // most of it, in this image: the robot's motion says more than what little is seen
  double contradicted_s = 0.0;     // for how long what was seen of an object in the hand contradicts that
  double slipped_unseen_s = kLongAgoS;        // since it did for some images
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
  /// @return true while nothing or little was ever seen of an object in a robot's hand.
  bool waitForTheHandToShowIt(const DepthImageView& depth, const SamplingGrid& grid, double dt_s,
                              const std::optional<ControlInput>& control);
  /// What is in view beside the hand, while nothing is known to be seen of the object: is it there, where the hand has
  /// it? nullopt when it is not, and nothing has changed.
  std::optional<FilterEstimate> lookPastTheHand(const DepthImageView& depth, const SamplingGrid& grid, double dt_s,
                                                const std::optional<ControlInput>& control);
  /// The remembered grasp goes where the hand carries it.
  void carryGrasp(double dt_s, const std::optional<ControlInput>& control);
  /// Starts the filter anew where the hand should have the object. @return false when the estimate is no worse.
  bool returnToGrasp(const DepthImageView& depth, double dt_s, const std::optional<ControlInput>& control,
                     FilterEstimate& estimate, const PoseAssessment& assessment);
  /// Starts the filter at a pose that is better than its own; where it leaves that for a worse one, it stays in the
  /// hand.
  FilterEstimate lookInHand(const DepthImageView& depth, double dt_s, const std::optional<ControlInput>& control,
                            const Pose& better);
  void startInHand(const Pose& T_camera_centre);
  /// Kept where the hand has it, because what is seen there draws away from it.
  bool waitsInHand() const { return is_blind && grasp_memory.pose() && status.state() == TrackerState::kInitializing; }
  /// A hand beside the object may explain more of the image than the object itself.
  bool leavesForWorse(const DepthImageView& depth, const Pose& T_camera_centre, const Pose& better);
  double scoreInHand() const;
  void rememberGrasp(const Pose& T_camera_centre, double dt_s);
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
  /// The first image after a pose was given: where that does not fit, it looks for one that does.
  struct GivenPose {
    Pose T_camera_centre;
    Vector6d variances;
  };
  void startFromGiven(const DepthImageView& depth, double dt_s, const std::optional<ControlInput>& control,
                      const GivenPose& given, FilterEstimate& estimate, PoseAssessment& assessment);
  PoseAssessment assess(const FilterEstimate& estimate);
  static bool fits(const PoseAssessment& assessment);
  bool seesNothing(const PoseAssessment& assessment) const;
  /// While the object vanishes behind something, to what remains in view: the arm that holds it.
  bool leaps(const DepthImageView& depth, const FilterEstimate& estimate);
  /// The paper's filter neither searches nor holds.
  bool mayReacquire() const { return config.filter.proposal == Proposal::kInformed; }
  /// Starts the filter anew where the object is seen. @return false when it is not.
  bool reacquire(const DepthImageView& depth, double dt_s);
  /// The estimate may be at a neighbouring mode: the image does not fit well, or the object was only just found.
  Doubt::Look whereToLook() const;
  bool moveToBetterPose(const DepthImageView& depth, const Pose& T_camera_centre, double dt_s);
  void startAt(const Pose& T_camera_centre);
  /// What was lost for a few images and found again moves on as it did meanwhile. After startAt().
  void keepMoving(const Pose& T_camera_centre, double dt_s);
  /// What was found a moment ago is not the object, by the images since. @return true when it is taken back.
  bool takeBackFind();
  void forgetFind();
  /// Moves to a pose that looks alike but explains the image better.
  void turnToLookAlike(FilterEstimate& estimate, PoseAssessment& assessment, double dt_s);
  /// About an axis that the image does not show: to where it should be or, where that is contradicted, to the middle.
  void turnToMiddle(FilterEstimate& estimate, PoseAssessment& assessment, double dt_s);
  /// Particles' velocities are relative to the hand while it is followed: hand over at grasp and release.
  void followHand(const ProcessStep& step, bool follows, double dt_s);
  void estimateSlip(const FilterEstimate& estimate, double dt_s);
  void rememberFit(const FilterEstimate& estimate, double dt_s);
  /// From time to time, where the object is surely seen.
  void learnFit(const DepthImageView& depth, double dt_s);
  /// Pose and velocity in the light of the images before: to be told, not to be tracked from.
  FilterEstimate smoothed(FilterEstimate estimate, double dt_s);
  void writeEstimate(const FilterEstimate& estimate);
  void writeStatus(const PoseAssessment& assessment);
};

}  // namespace depth_object_tracker
