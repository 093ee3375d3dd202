// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/tracker_session.h"

#include "depth_object_tracker/ros/image_conversions.h"
#include "depth_object_tracker/ros/message_conversions.h"
#include "depth_object_tracker/ros/pose_validation.h"
#include "depth_object_tracker/ros/status_reason.h"

#include <cmath>
#include <sstream>
#include <utility>

namespace depth_object_tracker {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kTransformTimeout{1};  // tf may come a little after the image
constexpr double kImageOutageS = 1.0;
constexpr double kGivenPoseReachS = 0.5;  // an initial pose holds for images about this near to its own

std::string withoutSlash(const std::string& frame) {
  return !frame.empty() && frame.front() == '/' ? frame.substr(1) : frame;
}

std::string describeGap(const std::string& topic, double gap_s) {
  std::ostringstream text;
  text << "image on '" << topic << "' has a stamp " << gap_s
       << " s after the one before: the camera stopped, or a clock was set; the object's velocity is forgotten";
  return text.str();
}

}  // namespace

TrackerSession::TrackerSession(const std::string& name, const std::string& image_topic, const std::string& info_topic,
                               tf2::BufferCore& tf)
    : image_topic_(image_topic),
      info_topic_(info_topic),
      intrinsics_(intrinsicsForTopic(image_topic)),
      tf_(tf),
      log_(name),
      self_check_(image_topic, info_topic) {
  object_.problem = "no object is loaded yet";
}

void TrackerSession::setTracker(BuiltTracker built) {
  object_ = std::move(built);
  shared_mesh_ = object_.tracker ? std::make_shared<TriangleMesh>(object_.tracker->object().mesh) : nullptr;
  self_check_.restart();
  budget_ = FrameBudget(object_.tracker ? object_.tracker->config().budget : BudgetConfig());
  abandon("another object was loaded");
  pending_pose_.reset();
  initial_pose_problem_.clear();
  given_pose_.reset();
  last_result_ = TrackerResult();
  last_stamp_s_.reset();
}

void TrackerSession::initialise(const InitialPose& pose, InitialisationCallback callback) {
  correction_.reset();
  abandon("superseded by a newer initial pose");
  waiting_ = std::move(callback);
  pending_pose_ = PendingPose{pose, std::nullopt};
  initial_pose_problem_.clear();
}

void TrackerSession::initialiseAnywhere(InitialisationCallback callback) {
  if (startWithoutPose(std::move(callback))) object_.tracker->initialiseAnywhere();
}

void TrackerSession::initialiseOnTable(InitialisationCallback callback) {
  if (startWithoutPose(std::move(callback))) object_.tracker->initialiseOnTable();
}

/// Forgets what was known of the pose; false, and told, when there is no object.
bool TrackerSession::startWithoutPose(InitialisationCallback callback) {
  correction_.reset();
  abandon("superseded by a search of the whole image");
  waiting_ = std::move(callback);
  pending_pose_.reset();
  given_pose_.reset();
  initial_pose_problem_.clear();
  if (!object_.tracker) {
    abandon("there is no object to track: " + object_.problem);
    return false;
  }
  last_result_ = TrackerResult();
  last_result_.state = TrackerState::kInitializing;  // also before the first image
  last_result_.reason = "the object is searched for from the next image on";
  return true;
}

bool TrackerSession::needsPose() const {
  const bool has_none = last_result_.state == TrackerState::kUninitialized || last_result_.state == TrackerState::kLost;
  return has_none && !pending_pose_;
}

void TrackerSession::refuseInitialPose(const std::string& problem) {
  log_.error(problem);
  initial_pose_problem_ = problem;
}

void TrackerSession::reset() {
  abandon("the tracker was reset");
  pending_pose_.reset();
  initial_pose_problem_.clear();
  given_pose_.reset();
  last_result_ = TrackerResult();
  last_stamp_s_.reset();
  if (object_.tracker) object_.tracker->reset();
}

void TrackerSession::setLiveParameters(const TrackerConfig& changed) {
  if (!object_.tracker) return;  // the parameter server keeps them for the next object
  object_.tracker->setLiveParameters(changed);
  budget_ = FrameBudget(object_.tracker->config().budget);
}

void TrackerSession::setRobot(BuiltRobot robot) {
  if (!robot.problem.empty()) log_.error(robot.problem);
  if (robot.connection) {
    log_.info("robot '" + robot.connection->model().name() + "' from '" + robot.connection->model().source() + "'");
  }
  for (const std::string& warning : robot.warnings) log_.warn(warning);
  held_motion_.setRobot(std::move(robot));
}

void TrackerSession::setGrasp(bool grasped, const std::string& link) {
  const bool is_same = grasped == held_motion_.isGrasped() && link == held_motion_.link();
  if (!is_same) correction_.reset();
  held_motion_.setGrasp(grasped, link);
  if (held_motion_.graspDetector()) held_motion_.graspDetector()->setHeld(grasped);
  const std::string problem = grasped ? findLinkProblem(link) : "";
  if (!problem.empty()) log_.error("the object is held, but " + problem);
}

void TrackerSession::addJointStates(const sensor_msgs::JointState& message) {
  if (!held_motion_.robot()) return;
  const std::string problem = held_motion_.robot()->addJointStates(message);
  if (!problem.empty()) log_.warn(problem);
}

void TrackerSession::addCommands(const sensor_msgs::JointState& message) {
  if (!held_motion_.robot()) return;
  const std::string problem = held_motion_.robot()->addCommands(message);
  if (!problem.empty()) log_.warn(problem);
}

void TrackerSession::addTwist(const geometry_msgs::TwistStamped& twist) {
  const std::string problem = held_motion_.addTwist(twist, camera_frame_, tf_);
  if (!problem.empty()) log_.warn(problem);
}

FrameOutcome TrackerSession::process(const CameraFrame& frame) {
  FrameOutcome outcome;
  outcome.header = frame.image->header;
  std::string problem = viewFrame(frame, outcome);
  last_header_ = outcome.header;
  if (problem.empty()) checkSetUp(frame, outcome);
  if (problem.empty() && !object_.tracker) problem = object_.problem;
  if (problem.empty()) problem = followCamera(outcome.header.stamp);
  if (!problem.empty()) {
    log_.warn(problem);
    outcome.result = refusedResult(problem);
    return outcome;
  }
  warnAboutCalibration(frame);
  initial_pose_problem_ = applyPendingPose(outcome);
  runTracker(outcome);
  placeOutput(outcome);
  return outcome;
}

std::chrono::steady_clock::time_point TrackerSession::transformDeadline() const {
  return Clock::now() +
         std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(frames_.transform_wait_s));
}

/// Tells the tracker how the camera has moved in the fixed frame since the last image; returns why that is not known.
/// An image from an unknown place is not used: taken as from the last one, it would move the object.
std::string TrackerSession::followCamera(const ros::Time& stamp) {
  T_now_before_ = Pose::Identity();
  if (frames_.fixed_frame.empty()) return "";
  const FrameLookup found = lookUpFrame(tf_, frames_.fixed_frame, camera_frame_, stamp, transformDeadline());
  if (!found.problem.empty()) {
    return "image on '" + image_topic_ + "' refused: " + found.problem +
           "; publish tf of the camera, or clear ~fixed_frame for a camera that stands still";
  }
  if (T_fixed_camera_) {
    T_now_before_ = found.T_target_source.inverse() * *T_fixed_camera_;
    object_.tracker->moveCamera(T_now_before_);
  }
  T_fixed_camera_ = found.T_target_source;
  return "";
}

/// Finds out how poses are taken to the frame that they are to be told in.
void TrackerSession::placeOutput(FrameOutcome& outcome) {
  outcome.output_frame = frames_.target_frame.empty() ? camera_frame_ : frames_.target_frame;
  if (!outcome.is_new_estimate || frames_.target_frame.empty()) return;
  outcome.output = lookUpFrame(tf_, outcome.output_frame, camera_frame_, outcome.header.stamp, transformDeadline());
  if (!outcome.output.problem.empty()) log_.warn("no pose is published: " + outcome.output.problem);
}

/// Fills depth and camera; returns why the image cannot be used.
std::string TrackerSession::viewFrame(const CameraFrame& frame, FrameOutcome& outcome) {
  const ImageViewResult image = viewDepthImage(*frame.image);
  if (!image.problem.empty()) return "image on '" + image_topic_ + "' refused: " + image.problem;
  if (!frame.info) {
    return "image on '" + image_topic_ + "' refused: no camera_info on '" + info_topic_ +
           "'; start its publisher or remap depth/camera_info";
  }
  const CameraResult camera = cameraFromInfo(*frame.info, intrinsics_, image.view.width, image.view.height);
  if (!camera.problem.empty()) {
    return "image on '" + image_topic_ + "' with camera_info on '" + info_topic_ + "' refused: " + camera.problem;
  }
  outcome.depth = image.view;
  outcome.camera = camera.camera;
  if (outcome.header.frame_id.empty()) outcome.header.frame_id = frame.info->header.frame_id;
  outcome.header.frame_id = withoutSlash(outcome.header.frame_id);
  camera_frame_ = outcome.header.frame_id;
  return "";
}

/// Tells what the self-check finds; the log throttles what stays as it is.
void TrackerSession::checkSetUp(const CameraFrame& frame, const FrameOutcome& outcome) {
  if (!self_check_.look(frame, outcome.depth, outcome.camera, object_.tracker.get())) return;
  for (const std::string& finding : self_check_.findings()) log_.warn(finding);
}

void TrackerSession::warnAboutCalibration(const CameraFrame& frame) {
  if (intrinsics_ == Intrinsics::kRaw && !distortion_reported_ && hasDistortion(*frame.info)) {
    distortion_reported_ = true;
    log_.warn("camera_info on '" + info_topic_ + "' has distortion, which is not corrected in the raw image on '" +
              image_topic_ + "': poses will be off near the borders; use the rectified topic (image_rect)");
  }
  if (camera_frame_.empty()) {
    log_.warn("neither image nor camera_info names a frame_id: no tf is published");
  }
}

/// Hands the pending pose to the tracker; returns why it cannot be done (yet).
std::string TrackerSession::applyPendingPose(const FrameOutcome& outcome) {
  if (!pending_pose_) return initial_pose_problem_;
  ResolvedPose resolved =
      resolveInitialPose(pending_pose_->pose, camera_frame_, tf_, {frames_.fixed_frame, last_header_.stamp});
  if (!resolved.problem.empty()) {
    if (!pending_pose_->deadline) pending_pose_->deadline = Clock::now() + kTransformTimeout;
    if (Clock::now() < *pending_pose_->deadline) return resolved.problem;
    log_.error(resolved.problem);
    pending_pose_.reset();
    abandon(resolved.problem);
    return resolved.problem;
  }
  const InitialisationConfig& defaults = object_.tracker->config().initialisation;
  resolved.covariance =
      fillMissingVariances(resolved.covariance, defaults.position_stddev_m, defaults.rotation_stddev_rad);
  object_.tracker->initialise(resolved.T_camera_object, resolved.covariance);
  pending_pose_.reset();
  given_pose_ = GivenPose{resolved.T_camera_object, resolved.covariance, outcome.header.stamp.toSec()};
  self_check_.lookAtPose(resolved.T_camera_object, outcome.depth, outcome.camera, *object_.tracker);
  for (const std::string& finding : self_check_.findings()) log_.warn(finding);
  return "";
}

/// When time jumps back to where the initial pose was given, as with a bag that loops, that pose holds again, and is
/// better than the one that the object had later.
bool TrackerSession::restoreGivenPose(double stamp_s) {
  const bool jumps_back = last_stamp_s_ && stamp_s < *last_stamp_s_;
  if (!jumps_back || !given_pose_ || std::abs(stamp_s - given_pose_->stamp_s) > kGivenPoseReachS) return false;
  object_.tracker->initialise(given_pose_->T_camera_object, given_pose_->covariance);
  return true;
}

std::optional<ControlInput> TrackerSession::controlFor(double stamp_s) {
  const HeldControl held = held_motion_.control(last_stamp_s_.value_or(stamp_s), stamp_s, camera_frame_,
                                                last_result_.T_camera_object, T_now_before_);
  if (!held.problem.empty()) {
    log_.warn("the object is held, but how it moves is not known; tracking goes on with wider noise: " + held.problem);
  }
  return held.control;
}

void TrackerSession::runTracker(FrameOutcome& outcome) {
  const double stamp_s = outcome.header.stamp.toSec();
  const bool is_restored = restoreGivenPose(stamp_s);
  object_.tracker->setEffort(budget_.effort());
  const Clock::time_point begin = Clock::now();
  outcome.result =
      object_.tracker->update(outcome.depth, outcome.camera, stamp_s, controlFor(stamp_s), placeOccluders(stamp_s));
  if (outcome.result.input == TrackerResult::Input::kUsed) {
    budget_.frameTook(std::chrono::duration<double>(Clock::now() - begin).count());
  }
  if (sharing_) sharing_->tell(camera_frame_, outcome.result, shared_mesh_);
  if (is_restored) outcome.result.input = TrackerResult::Input::kTimeJumpedBack;
  outcome.processed = outcome.result.input != TrackerResult::Input::kDuplicateStamp;
  const double gap_s = stamp_s - last_stamp_s_.value_or(stamp_s);
  if (gap_s > object_.tracker->config().process.max_gap_s) log_.warn(describeGap(image_topic_, gap_s));
  last_stamp_s_ = stamp_s;
  reportInput(outcome, is_restored);
  const bool has_state_to_tell = outcome.result.state != TrackerState::kUninitialized && outcome.result.has_pose;
  outcome.is_new_estimate = outcome.processed && has_state_to_tell;
  if (outcome.result.state == TrackerState::kTracking) self_check_.forgetPose();
  explainState(initial_pose_problem_, self_check_.findings(), outcome.result);
  last_result_ = outcome.result;
  if (outcome.processed) describeHand(outcome);
  if (outcome.processed) detectGrasp(outcome);
  answerWaiting(outcome);
}

/// The robot's links and the other tracked objects for this image; null where there are none.
KnownOccluders* TrackerSession::placeOccluders(double stamp_s) {
  KnownOccluders* robot = placeRobot(stamp_s);
  if (!sharing_) return robot;
  return others_->place(sharing_->hear(camera_frame_), stamp_s, robot) > 0 ? others_.get() : nullptr;
}

/// The robot's links for this image; null where it is not known where they are.
KnownOccluders* TrackerSession::placeRobot(double stamp_s) {
  if (held_motion_.occluder() == nullptr) return nullptr;
  const LinkInCamera root = held_motion_.robot()->locateRoot(camera_frame_, stamp_s);
  if (!root.problem.empty()) return nullptr;
  const std::size_t placed = held_motion_.occluder()->place(held_motion_.robot()->state(), root.T_camera_link, stamp_s);
  return placed > 0 ? held_motion_.occluder() : nullptr;
}

/// What the held object says of the hand. Nothing is concluded from an object that is not seen.
void TrackerSession::describeHand(FrameOutcome& outcome) {
  const TrackerResult& result = outcome.result;
  if (!result.slip || result.state != TrackerState::kTracking) return;
  HandReport report;
  report.link = held_motion_.followsLink() ? held_motion_.link() : "";
  report.slip = *result.slip;
  report.T_camera_object = result.T_camera_object;
  report.covariance = result.covariance;
  if (!report.link.empty()) {
    const double stamp_s = outcome.header.stamp.toSec();
    const LinkInCamera link = held_motion_.robot()->locate(report.link, camera_frame_, stamp_s);
    if (!link.problem.empty()) return;  // said where the control was made
    report.T_camera_link = link.T_camera_link;
    report.observed = correction_.update(stamp_s, link.T_camera_link, result.T_camera_object, result.slip->slipping);
  }
  outcome.hand = report;
}

void TrackerSession::detectGrasp(const FrameOutcome& outcome) {
  GraspDetector* detector = held_motion_.graspDetector();
  if (detector == nullptr || outcome.result.state != TrackerState::kTracking) return;
  const double stamp_s = outcome.header.stamp.toSec();
  const std::string& link = detector->config().link;
  const LinkInCamera hand = held_motion_.robot()->locate(link, camera_frame_, stamp_s);
  const auto joint = held_motion_.robot()->jointPosition(detector->config().joint, stamp_s);
  if (!hand.problem.empty() || !joint) {
    log_.warn("grasp detection waits: " +
              (hand.problem.empty() ? "joint '" + detector->config().joint + "' is not reported" : hand.problem));
    return;
  }
  const auto held = detector->update(stamp_s, *joint, hand.T_camera_link.inverse() * outcome.result.T_camera_object);
  if (!held) return;
  log_.info(*held ? "link '" + link + "' holds the object" : "link '" + link + "' does not hold the object any more");
  correction_.reset();
  held_motion_.setGrasp(*held, *held ? link : "");
}

/// Says in the log, and where it explains the state also in the reason, what was wrong with the image.
void TrackerSession::reportInput(FrameOutcome& outcome, bool is_restored) {
  TrackerResult& result = outcome.result;
  const std_msgs::Header& header = outcome.header;
  using Input = TrackerResult::Input;
  if (result.input == Input::kUsed && result.state != TrackerState::kUninitialized &&
      result.valid_pixel_fraction <= 0.0) {
    result.input = Input::kNoValidDepth;
  }
  const std::string image = "image on '" + image_topic_ + "' ";
  std::ostringstream text;
  switch (result.input) {
    case Input::kUsed:
      return;
    case Input::kDuplicateStamp:
      text << image << "ignored: its stamp " << header.stamp
           << " repeats the one before; check the driver, or for two publishers on the topic";
      break;
    case Input::kTimeJumpedBack:
      text << image << "jumped back in time, to " << header.stamp
           << " (a bag that loops, or a clock that was set): starting anew from the "
           << (is_restored ? "initial" : "last") << " pose";
      held_motion_.forget();
      if (ros::Time::isSimTime()) tf_.clear();  // keeps static transforms
      break;
    case Input::kNoValidDepth:
      text << image
           << "has no valid depth within max_depth_m (0 % of the pixels looked at): is the unit right (16UC1 "
              "millimetres, 32FC1 metres)? is the lens covered, or everything too near?";
      break;
    case Input::kUnusable:
      text << image << "cannot be used: " << result.reason;
      break;
  }
  log_.warn(text.str());
  if (result.input == Input::kNoValidDepth && result.state != TrackerState::kTracking) result.reason = text.str();
}

void TrackerSession::answerWaiting(const FrameOutcome& outcome) {
  if (!waiting_ || pending_pose_ || outcome.result.state != TrackerState::kTracking) return;
  InitialisationOutcome answer;
  answer.success = true;
  answer.message = "tracking '" + object_.name + "'";
  answer.pose.header = outcome.header;
  answer.pose.pose = toPoseMessage(outcome.result.T_camera_object, outcome.result.covariance);
  std::exchange(waiting_, nullptr)(answer);
}

void TrackerSession::abandon(const std::string& message) {
  if (!waiting_) return;
  InitialisationOutcome answer;
  answer.message = message;
  std::exchange(waiting_, nullptr)(answer);
}

/// In an image that cannot be used the object is not seen, which is not the same as tracked.
TrackerResult TrackerSession::refusedResult(const std::string& reason) const {
  TrackerResult result = last_result_;
  if (result.state == TrackerState::kTracking) result.state = TrackerState::kOccluded;
  result.input = TrackerResult::Input::kUnusable;
  result.reason = reason;
  return result;
}

TrackerResult TrackerSession::idleResult(double seconds_without_image) const {
  if (!object_.tracker) return refusedResult(object_.problem);
  if (!paused_ && seconds_without_image > kImageOutageS) {
    std::ostringstream reason;
    reason << "no image on '" << image_topic_ << "' for " << static_cast<int>(seconds_without_image)
           << " s: is the camera (or the bag) running, and is the topic right?";
    return refusedResult(reason.str());
  }
  TrackerResult result = last_result_;
  if (result.state == TrackerState::kTracking) return result;
  if (!initial_pose_problem_.empty()) {
    result.reason = initial_pose_problem_;
  } else if (paused_) {
    result.reason = "paused; call ~pause with data: false to go on";
  } else if (result.state == TrackerState::kUninitialized && !pending_pose_) {
    result.reason = kNoInitialPoseReason;
  }
  return result;
}

}  // namespace depth_object_tracker
