// SPDX-License-Identifier: BSD-3-Clause
// What the tracker's thread knows and does: object, pending initial pose, grasp; one image in, one outcome out.
#pragma once

#include "depth_object_tracker/ros/camera_conversions.h"
#include "depth_object_tracker/ros/frame_inbox.h"
#include "depth_object_tracker/ros/frame_lookup.h"
#include "depth_object_tracker/ros/hand_messages.h"
#include "depth_object_tracker/ros/held_motion.h"
#include "depth_object_tracker/ros/initial_pose_resolver.h"
#include "depth_object_tracker/ros/object_source.h"
#include "depth_object_tracker/ros/self_check.h"
#include "depth_object_tracker/ros/throttled_log.h"
#include "depth_object_tracker/tracker/estimate_board.h"
#include "depth_object_tracker/tracker/frame_budget.h"

#include <depth_object_tracker/Grasp.h>
#include <geometry_msgs/TwistStamped.h>
#include <std_msgs/Header.h>

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace depth_object_tracker {

/// What became of one image.
struct FrameOutcome {
  std_msgs::Header header;       ///< of the image
  bool processed = false;        ///< the tracker saw it; otherwise `result` is what was known before
  bool is_new_estimate = false;  ///< pose, twist and the rest are worth publishing
  TrackerResult result;          ///< state and reason as they go into the status
  DepthImageView depth;          ///< valid as long as the image; empty when not processed
  PinholeCamera camera;
  std::optional<HandReport> hand;  ///< while the object is held and follows the hand
  std::string output_frame;        ///< where poses are to be told; the camera's frame or ~target_frame
  FrameLookup output;              ///< T_target_source from the camera's frame to that one
};

/// How an initialisation that somebody waits for ended.
struct InitialisationOutcome {
  bool success = false;
  std::string message;
  geometry_msgs::PoseWithCovarianceStamped pose;
};
using InitialisationCallback = std::function<void(const InitialisationOutcome&)>;

/// Lives on the tracker's thread; knows no topic, so that tests need no ROS master. Not thread-safe. Nothing throws but
/// std::bad_alloc.
class TrackerSession {
 public:
  /// @param tf outlives the session. @param image_topic for messages, and to tell raw from rectified images.
  TrackerSession(const std::string& name, const std::string& image_topic, const std::string& info_topic,
                 tf2::BufferCore& tf);

  void setFrames(const FrameOptions& frames) { frames_ = frames; }

  /// From now on the trackers on this board know of one another: a nearer object is a known occluder of a farther one,
  /// and none is taken for another.
  void share(std::shared_ptr<EstimateBoard> board) { sharing_ = std::make_unique<BoardMembership>(std::move(board)); }

  /// Takes a new object (or the problem that there is none), forgetting the old one's pose.
  void setTracker(BuiltTracker built);

  /// Starts anew from this pose at the next image. @param callback is told when TRACKING, or that it was given up; may
  /// be empty.
  void initialise(const InitialPose& pose, InitialisationCallback callback);

  /// Starts anew with nothing but the images, from the next one on. @param callback as above.
  void initialiseAnywhere(InitialisationCallback callback);

  /// Likewise, with the object resting on a plane that the images show.
  void initialiseOnTable(InitialisationCallback callback);

  /// True while UNINITIALIZED or LOST with no initial pose under way: a detector's pose is then welcome.
  bool needsPose() const;

  /// Says in log and status why a wished pose was refused; what is tracked goes on.
  void refuseInitialPose(const std::string& problem);
  void reset();
  void setLiveParameters(const TrackerConfig& changed);
  void setPaused(bool paused) { paused_ = paused; }

  /// Says what is wrong with the robot, if anything; without one, grasps by links are held by an unknown motion.
  void setRobot(BuiltRobot robot);

  /// @return empty, or why the link's motion cannot be known.
  std::string findLinkProblem(const std::string& link) const { return held_motion_.findLinkProblem(link); }
  void setGrasp(bool grasped, const std::string& link);
  void addTwist(const geometry_msgs::TwistStamped& twist);
  void addJointStates(const sensor_msgs::JointState& message);
  void addCommands(const sensor_msgs::JointState& message);

  /// True when the image's control (twist, joints, tf) is not here yet but may well come.
  bool awaitsControl(const ros::Time& stamp) const {
    return !paused_ && held_motion_.awaitsControl(stamp.toSec(), camera_frame_);
  }

  FrameOutcome process(const CameraFrame& frame);

  /// What the status says when there is no image: the last result with the reason why nothing happens.
  TrackerResult idleResult(double seconds_without_image) const;

  /// Ends everybody's waiting, with this message.
  void abandon(const std::string& message);

  const TrackerResult& lastResult() const { return last_result_; }
  const BuiltTracker& object() const { return object_; }
  bool paused() const { return paused_; }
  bool grasped() const { return held_motion_.isGrasped(); }
  const std::string& cameraFrame() const { return camera_frame_; }
  const std_msgs::Header& lastHeader() const { return last_header_; }

  /// What the self-check finds suspicious, one sentence each.
  std::vector<std::string> findings() const { return self_check_.findings(); }

  /// Why the tree of frames cannot place the camera; "" when it can, or when no image has come yet.
  std::string missingParent() const { return describeMissingParent(camera_frame_, tf_); }

 private:
  struct PendingPose {
    InitialPose pose;
    std::optional<std::chrono::steady_clock::time_point> deadline;  // set at the first image
  };

  /// The last initial pose that was granted, and the image that it was used for.
  struct GivenPose {
    Pose T_camera_object;
    Matrix6d covariance;
    double stamp_s;
  };

  std::string viewFrame(const CameraFrame& frame, FrameOutcome& outcome);
  void warnAboutCalibration(const CameraFrame& frame);
  void checkSetUp(const CameraFrame& frame, const FrameOutcome& outcome);
  bool startWithoutPose(InitialisationCallback callback);
  std::string applyPendingPose(const FrameOutcome& outcome);
  bool restoreGivenPose(double stamp_s);
  std::string followCamera(const ros::Time& stamp);
  void placeOutput(FrameOutcome& outcome);
  std::chrono::steady_clock::time_point transformDeadline() const;
  std::optional<ControlInput> controlFor(double stamp_s);
  void runTracker(FrameOutcome& outcome);
  void detectGrasp(const FrameOutcome& outcome);
  void describeHand(FrameOutcome& outcome);
  KnownOccluders* placeRobot(double stamp_s);
  KnownOccluders* placeOccluders(double stamp_s);
  void reportInput(FrameOutcome& outcome, bool is_restored);
  void answerWaiting(const FrameOutcome& outcome);
  TrackerResult refusedResult(const std::string& reason) const;

  std::string image_topic_;
  std::string info_topic_;
  Intrinsics intrinsics_;
  tf2::BufferCore& tf_;
  FrameOptions frames_;
  std::unique_ptr<BoardMembership> sharing_;  // null: nothing is told or heard
  std::shared_ptr<const TriangleMesh> shared_mesh_;
  std::unique_ptr<OtherObjects> others_ = std::make_unique<OtherObjects>();
  std::optional<Pose> T_fixed_camera_;    // at the last image that the tracker saw
  Pose T_now_before_ = Pose::Identity();  // how far the camera has moved in the fixed frame since then
  ThrottledLog log_;
  SelfCheck self_check_;

  BuiltTracker object_;
  FrameBudget budget_{BudgetConfig()};
  std::string initial_pose_problem_;  // why the last wish for an initial pose was not granted
  std::optional<PendingPose> pending_pose_;
  std::optional<GivenPose> given_pose_;
  InitialisationCallback waiting_;
  bool paused_ = false;
  bool distortion_reported_ = false;
  HeldMotion held_motion_;
  KinematicCorrection correction_;
  TrackerResult last_result_;
  std::optional<double> last_stamp_s_;  // of the last image that the tracker saw
  std::string camera_frame_;
  std_msgs::Header last_header_;
};

}  // namespace depth_object_tracker
