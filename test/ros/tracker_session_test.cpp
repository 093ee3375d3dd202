// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/tracker_session.h"

#include "depth_messages.h"
#include "depth_object_tracker/ros/message_conversions.h"

#include <gtest/gtest.h>
#include <tf2/buffer_core.h>
#include <boost/make_shared.hpp>

#include <thread>

namespace depth_object_tracker {
namespace {

constexpr double kFrameS = 1.0 / 30.0;

class TrackerSessionTest : public testing::Test {
 protected:
  TrackerSessionTest() : session_("test", "/camera/depth/image_raw", "/camera/depth/camera_info", tf_) {
    ObjectSource source;
    source.mesh = testMeshFile();
    TrackerConfig config;
    config.filter.num_particles = 40;
    session_.setTracker(buildTracker(source, config));
  }

  void initialise(const Pose& T_camera_object, const std::string& frame = "") {
    InitialPose pose;
    pose.frame_id = frame;
    pose.stamp = ros::Time(stamp_s_);
    pose.T_frame_object = T_camera_object;
    session_.initialise(pose, [this](const InitialisationOutcome& outcome) { outcomes_.push_back(outcome); });
  }

  sensor_msgs::ImagePtr imageAt(const Pose& T_camera_object) {
    const auto image = makeUint16Image(scene_.depth(T_camera_object), testCamera().width, testCamera().height);
    image->header.stamp = ros::Time(stamp_s_);
    return image;
  }

  FrameOutcome process(const sensor_msgs::ImageConstPtr& image, const sensor_msgs::CameraInfoConstPtr& info) {
    frame_ = CameraFrame{image, info, std::chrono::steady_clock::now()};
    return session_.process(frame_);
  }

  FrameOutcome step(const Pose& T_camera_object) {
    stamp_s_ += kFrameS;
    return process(imageAt(T_camera_object), makeCameraInfo(testCamera()));
  }

  static double errorM(const FrameOutcome& outcome, const Pose& T_camera_object) {
    return (outcome.result.T_camera_object.translation() - T_camera_object.translation()).norm();
  }

  void expectTracking(const Pose& T_camera_object) {
    FrameOutcome outcome;
    for (int i = 0; i < 5; ++i) outcome = step(T_camera_object);
    EXPECT_EQ(outcome.result.state, TrackerState::kTracking) << outcome.result.reason;
    EXPECT_EQ(outcome.result.reason, "");
    EXPECT_TRUE(outcome.is_new_estimate);
    EXPECT_LT(errorM(outcome, T_camera_object), 0.003);
  }

  void expectRefused(const FrameOutcome& outcome, const std::string& what) {
    EXPECT_FALSE(outcome.processed);
    EXPECT_FALSE(outcome.is_new_estimate);
    EXPECT_NE(outcome.result.state, TrackerState::kTracking);
    EXPECT_NE(outcome.result.reason.find(what), std::string::npos) << outcome.result.reason;
    EXPECT_NE(outcome.result.reason.find("/camera/depth/image_raw"), std::string::npos) << outcome.result.reason;
  }

  TestScene scene_;
  tf2::BufferCore tf_;
  TrackerSession session_;
  CameraFrame frame_;
  double stamp_s_ = 1000.0;
  std::vector<InitialisationOutcome> outcomes_;
};

TEST_F(TrackerSessionTest, WaitsForAnInitialPoseAndSaysSo) {
  const FrameOutcome outcome = step(testPose());
  EXPECT_EQ(outcome.result.state, TrackerState::kUninitialized);
  EXPECT_FALSE(outcome.is_new_estimate);
  EXPECT_NE(session_.idleResult(0.0).reason.find("~initialize"), std::string::npos);
}

TEST_F(TrackerSessionTest, TracksAndAnswersWhoWaits) {
  initialise(testPose());
  expectTracking(testPose());
  ASSERT_EQ(outcomes_.size(), 1u);
  EXPECT_TRUE(outcomes_[0].success) << outcomes_[0].message;
  EXPECT_EQ(outcomes_[0].pose.header.frame_id, "camera_depth_optical_frame");
  EXPECT_NEAR(outcomes_[0].pose.pose.pose.position.z, 0.6, 0.01);
}

TEST_F(TrackerSessionTest, ReadsTheImageInPlace) {
  initialise(testPose());
  const auto image = imageAt(testPose());
  EXPECT_EQ(process(image, makeCameraInfo(testCamera())).depth.data, image->data.data());
}

TEST_F(TrackerSessionTest, RefusesBadImagesAndGoesOn) {
  initialise(testPose());
  expectTracking(testPose());

  auto image = imageAt(testPose());
  image->data.resize(image->data.size() / 2);
  expectRefused(process(image, makeCameraInfo(testCamera())), "bytes");
  image = imageAt(testPose());
  image->encoding = "bgr8";
  expectRefused(process(image, makeCameraInfo(testCamera())), "bgr8");
  auto info = makeCameraInfo(testCamera());
  info->width = 640;
  expectRefused(process(imageAt(testPose()), info), "/camera/depth/camera_info");
  info = makeCameraInfo(testCamera());
  info->K.fill(0.0);
  expectRefused(process(imageAt(testPose()), info), "fx=0");
  expectRefused(process(imageAt(testPose()), nullptr), "no camera_info");

  expectTracking(testPose());
}

TEST_F(TrackerSessionTest, IgnoresARepeatedStamp) {
  initialise(testPose());
  expectTracking(testPose());
  const FrameOutcome outcome = process(imageAt(testPose()), makeCameraInfo(testCamera()));
  EXPECT_FALSE(outcome.processed);
  EXPECT_FALSE(outcome.is_new_estimate);
  expectTracking(testPose());
}

TEST_F(TrackerSessionTest, TakesAnInitialPoseInAnyFrame) {
  Pose T_world_camera = Pose::Identity();
  T_world_camera.translation() = Eigen::Vector3d(1.0, 2.0, 3.0);
  T_world_camera.linear() = expSo3(Eigen::Vector3d(-1.5, 0.2, 0.4));
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = "world";
  transform.child_frame_id = "camera_depth_optical_frame";
  transform.transform = toTransformMessage(T_world_camera);
  tf_.setTransform(transform, "test", true);
  initialise(T_world_camera * testPose(), "world");
  expectTracking(testPose());
}

TEST_F(TrackerSessionTest, GivesUpOnAFrameThatTfDoesNotKnow) {
  initialise(testPose(), "nowhere");
  EXPECT_NE(step(testPose()).result.reason.find("nowhere"), std::string::npos);
  EXPECT_TRUE(outcomes_.empty());  // tf may be late
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  const FrameOutcome outcome = step(testPose());
  EXPECT_NE(outcome.result.reason.find("nowhere"), std::string::npos) << outcome.result.reason;
  ASSERT_EQ(outcomes_.size(), 1u);
  EXPECT_FALSE(outcomes_[0].success);
  initialise(testPose());
  expectTracking(testPose());
}

TEST_F(TrackerSessionTest, ANewerInitialPoseEndsTheWaitingForTheOlder) {
  initialise(testPose());
  initialise(testPose());
  ASSERT_EQ(outcomes_.size(), 1u);
  EXPECT_FALSE(outcomes_[0].success);
  session_.reset();
  EXPECT_EQ(outcomes_.size(), 2u);
  EXPECT_EQ(step(testPose()).result.state, TrackerState::kUninitialized);
}

TEST_F(TrackerSessionTest, FollowsAHeldObjectByItsControlTwist) {
  initialise(testPose());
  expectTracking(testPose());
  session_.setGrasp(true, "");
  Pose pose = testPose();
  FrameOutcome outcome;
  for (int i = 0; i < 15; ++i) {
    pose.translation().x() += 0.02;  // 0.6 m/s: known from the twist alone while nothing is seen
    geometry_msgs::TwistStamped twist;
    twist.header.stamp = ros::Time(stamp_s_ + kFrameS);
    twist.twist.linear.x = 0.02 / kFrameS;
    session_.addTwist(twist);
    EXPECT_FALSE(session_.awaitsControl(twist.header.stamp));
    outcome = step(pose);
  }
  EXPECT_TRUE(outcome.result.grasped);
  EXPECT_EQ(outcome.result.state, TrackerState::kTracking) << outcome.result.reason;
  EXPECT_LT(errorM(outcome, pose), 0.005);
  EXPECT_TRUE(session_.awaitsControl(ros::Time(stamp_s_ + kFrameS)));
  EXPECT_FALSE(session_.awaitsControl(ros::Time(stamp_s_ + 1.0)));  // the stream has ended
}

TEST_F(TrackerSessionTest, ABagThatLoopsFindsItsInitialPoseAgain) {
  initialise(testPose());
  expectTracking(testPose());
  Pose pose = testPose();
  for (int i = 0; i < 40; ++i) {  // far enough away that searching near the last pose finds nothing
    pose.translation().x() -= 0.004;
    step(pose);
  }
  expectTracking(pose);
  stamp_s_ = 1000.0;
  EXPECT_EQ(step(testPose()).result.input, TrackerResult::Input::kTimeJumpedBack);
  expectTracking(testPose());
}

TEST_F(TrackerSessionTest, ATimeJumpElsewhereKeepsTheLastPose) {
  initialise(testPose());
  expectTracking(testPose());
  stamp_s_ += 20.0;
  expectTracking(testPose());
  stamp_s_ -= 10.0;
  EXPECT_EQ(step(testPose()).result.input, TrackerResult::Input::kTimeJumpedBack);
  expectTracking(testPose());
}

TEST_F(TrackerSessionTest, SaysWhenNoImageComes) {
  initialise(testPose());
  expectTracking(testPose());
  const TrackerResult idle = session_.idleResult(3.0);
  EXPECT_NE(idle.state, TrackerState::kTracking);
  EXPECT_NE(idle.reason.find("no image on '/camera/depth/image_raw'"), std::string::npos) << idle.reason;
}

// What the self-check finds is the status's reason until the object is tracked. Each mistake by itself; the judgement
// is tested with input_check.h.
class TrackerSessionSelfCheck : public TrackerSessionTest {
 protected:
  void expectReason(const FrameOutcome& outcome, const std::vector<std::string>& parts) {
    EXPECT_NE(outcome.result.state, TrackerState::kTracking);
    for (const std::string& part : parts) {
      EXPECT_NE(outcome.result.reason.find(part), std::string::npos) << part << " is not in: " << outcome.result.reason;
    }
    EXPECT_FALSE(session_.findings().empty());
  }

  FrameOutcome stepWith(const PinholeCamera& camera) {
    stamp_s_ += kFrameS;
    return process(imageAt(testPose()), makeCameraInfo(camera));
  }
};

TEST_F(TrackerSessionSelfCheck, FindsNothingInAGoodSetUp) {
  initialise(testPose());
  expectTracking(testPose());
  EXPECT_TRUE(session_.findings().empty()) << session_.findings().front();
}

TEST_F(TrackerSessionSelfCheck, MeshInMillimetres) {
  ObjectSource source;
  source.mesh = testMeshFile();
  source.mesh_scale = 1000.0;
  session_.setTracker(buildTracker(source, TrackerConfig()));
  initialise(testPose());
  const FrameOutcome outcome = step(testPose());  // refused when it is loaded
  EXPECT_NE(outcome.result.reason.find("try mesh_scale 1"), std::string::npos) << outcome.result.reason;
}

TEST_F(TrackerSessionSelfCheck, MeshLargerThanTheView) {
  ObjectSource source;
  source.mesh = testMeshFile();
  source.mesh_scale = 30.0;
  session_.setTracker(buildTracker(source, TrackerConfig()));
  initialise(testPose());
  expectReason(step(testPose()), {"bracket", "in millimetres?", "mesh_scale"});
}

TEST_F(TrackerSessionSelfCheck, FocalLengthsSwapped) {
  PinholeCamera camera = testCamera();
  camera.fx = 380.0;
  expectReason(stepWith(camera), {"/camera/depth/camera_info", "fx is 380.0", "swapped"});
}

TEST_F(TrackerSessionSelfCheck, CalibrationOfAnotherResolution) {
  PinholeCamera camera = testCamera();
  camera.cx = 319.5, camera.cy = 239.5;
  expectReason(stepWith(camera), {"/camera/depth/camera_info", "640x480"});
}

TEST_F(TrackerSessionSelfCheck, DepthInTheWrongUnit) {
  auto depth_m = scene_.depth(testPose());
  for (float& depth : depth_m) depth *= 1000.0f;
  const auto image = makeFloatImage(depth_m, testCamera().width, testCamera().height);
  image->header.stamp = ros::Time(stamp_s_);
  expectReason(process(image, makeCameraInfo(testCamera())), {"/camera/depth/image_raw", "32FC1 must be metres"});
}

TEST_F(TrackerSessionSelfCheck, NoValidDepthBeforeAnyPose) {
  stamp_s_ += kFrameS;
  const auto image = makeUint16Image(std::vector<float>(320 * 240, 0.0f), 320, 240);
  image->header.stamp = ros::Time(stamp_s_);
  expectReason(process(image, makeCameraInfo(testCamera())), {"/camera/depth/image_raw", "no valid depth", "lens"});
}

TEST_F(TrackerSessionSelfCheck, PoseWhereNothingIs) {
  Pose pose = testPose();
  pose.translation().x() -= 0.25;
  initialise(pose);
  expectReason(step(testPose()), {"initial pose", "object is not there"});
  initialise(testPose());
  expectTracking(testPose());
  EXPECT_TRUE(session_.findings().empty()) << session_.findings().front();
}

TEST_F(TrackerSessionSelfCheck, AHiddenObjectIsToldAsHidden) {
  const auto info = makeCameraInfo(testCamera());
  info->header.frame_id = "other_camera";  // suspicious, but good enough
  initialise(testPose());
  const auto stepWithImage = [&](const sensor_msgs::ImagePtr& image) {
    stamp_s_ += kFrameS;
    image->header.stamp = ros::Time(stamp_s_);
    return process(image, info);
  };
  for (int i = 0; i < 6; ++i) EXPECT_TRUE(stepWithImage(imageAt(testPose())).processed);
  EXPECT_FALSE(session_.findings().empty());
  FrameOutcome outcome;
  for (int i = 0; i < 5; ++i) outcome = stepWithImage(makeUint16Image(std::vector<float>(320 * 240, 0.4f), 320, 240));
  EXPECT_EQ(outcome.result.state, TrackerState::kOccluded);
  EXPECT_NE(outcome.result.reason.find("hidden"), std::string::npos) << outcome.result.reason;
}

TEST_F(TrackerSessionSelfCheck, FramesOfTwoCameras) {
  const auto info = makeCameraInfo(testCamera());
  info->header.frame_id = "other_camera";
  stamp_s_ += kFrameS;
  expectReason(process(imageAt(testPose()), info), {"other_camera", "camera_depth_optical_frame"});
}

TEST_F(TrackerSessionSelfCheck, SaysWhenTfDoesNotKnowTheCamera) {
  EXPECT_EQ(session_.missingParent(), "");  // no image yet
  step(testPose());
  EXPECT_NE(session_.missingParent().find("camera_depth_optical_frame"), std::string::npos);
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = "world";
  transform.child_frame_id = "camera_depth_optical_frame";
  transform.transform = toTransformMessage(Pose::Identity());
  tf_.setTransform(transform, "test", true);
  EXPECT_EQ(session_.missingParent(), "");
}

}  // namespace
}  // namespace depth_object_tracker
