// SPDX-License-Identifier: BSD-3-Clause
// A camera that is carried around an object at rest, and one that stands still while its estimates are told elsewhere.
#include "depth_object_tracker/ros/tracker_session.h"

#include "depth_messages.h"
#include "depth_object_tracker/ros/message_conversions.h"

#include <gtest/gtest.h>
#include <tf2/buffer_core.h>

#include <cmath>
#include <limits>
#include <thread>

namespace depth_object_tracker {
namespace {

constexpr double kFrameS = 1.0 / 30.0;
const std::string kCamera = "camera_depth_optical_frame";

/// The object's place in the world.
Pose truthInWorld() {
  Pose T_world_object = Pose::Identity();
  T_world_object.translation() = Eigen::Vector3d(1.0, 2.0, 0.8);
  T_world_object.linear() = expSo3(Eigen::Vector3d(0.4, 0.3, -0.7));
  return T_world_object;
}

/// Swings around the object: up to 0.35 m/s and 0.5 rad/s; turned by a quarter against the world.
Pose cameraInWorld(double time_s) {
  Pose T_world_camera = truthInWorld();
  T_world_camera.linear() = expSo3(Eigen::Vector3d(0.0, 0.0, M_PI_2)) *
                            expSo3(Eigen::Vector3d(0.1 * std::sin(1.5 * time_s), 0.25 * std::sin(2.0 * time_s), 0.0));
  T_world_camera.translation() -= T_world_camera.linear() * Eigen::Vector3d(0.03 * std::sin(3.0 * time_s), 0.0, 0.7);
  return T_world_camera;
}

class CarriedCamera : public testing::Test {
 protected:
  CarriedCamera() : session_("test", "/camera/depth/image_raw", "/camera/depth/camera_info", tf_) {
    ObjectSource source;
    source.mesh = testMeshFile();
    TrackerConfig config;
    config.filter.num_particles = 40;
    config.budget.frame_budget_s = 0.0;  // the same on a slow machine, and under a sanitizer
    session_.setTracker(buildTracker(source, config));
  }

  void setFrames(const std::string& target, const std::string& fixed, double wait_s = 0.0) {
    session_.setFrames({target, fixed, wait_s});
  }

  static double time(int frame) { return 1000.0 + frame * kFrameS; }

  void sendTransform(double time_s) {
    geometry_msgs::TransformStamped transform;
    transform.header.stamp = ros::Time(time_s);
    transform.header.frame_id = "world";
    transform.child_frame_id = kCamera;
    transform.transform = toTransformMessage(cameraInWorld(time_s));
    tf_.setTransform(transform, "test");
  }

  void initialise() {
    InitialPose pose;
    pose.frame_id = "world";
    pose.T_frame_object = truthInWorld();
    session_.initialise(pose, nullptr);
  }

  /// @param is_hidden the image has no readings
  FrameOutcome process(int frame, bool is_hidden = false) {
    auto depth_m = scene_.depth(cameraInWorld(time(frame)).inverse() * truthInWorld());
    if (is_hidden) depth_m.assign(depth_m.size(), 0.0f);
    const auto image = makeUint16Image(depth_m, testCamera().width, testCamera().height);
    image->header.stamp = ros::Time(time(frame));
    frame_ = CameraFrame{image, makeCameraInfo(testCamera()), std::chrono::steady_clock::now()};
    return session_.process(frame_);
  }

  FrameOutcome step(int frame, bool is_hidden = false) {
    sendTransform(time(frame));
    return process(frame, is_hidden);
  }

  /// Distance of the estimate from the truth [m].
  static double errorM(const FrameOutcome& outcome, int frame) {
    const Pose T_world_object = cameraInWorld(time(frame)) * outcome.result.T_camera_object;
    return (T_world_object.translation() - truthInWorld().translation()).norm();
  }

  TestScene scene_;
  tf2::BufferCore tf_;
  TrackerSession session_;
  CameraFrame frame_;
};

TEST_F(CarriedCamera, AnObjectAtRestRests) {
  setFrames("", "world");
  initialise();
  for (int frame = 0; frame < 90; ++frame) {
    const FrameOutcome outcome = step(frame);
    if (frame < 15) continue;
    ASSERT_EQ(outcome.result.state, TrackerState::kTracking) << frame << ": " << outcome.result.reason;
    EXPECT_LT(errorM(outcome, frame), 0.002) << frame;
    EXPECT_LT(outcome.result.twist.head<3>().norm(), 0.04) << frame;
    EXPECT_EQ(outcome.output_frame, kCamera);
  }
}

TEST_F(CarriedCamera, WithoutAFixedFrameTheObjectMovesInstead) {
  setFrames("", "");
  initialise();
  double fastest_m_s = 0.0;
  for (int frame = 0; frame < 90; ++frame) {
    const FrameOutcome outcome = step(frame);
    if (frame >= 15) fastest_m_s = std::max(fastest_m_s, outcome.result.twist.head<3>().norm());
  }
  EXPECT_GT(fastest_m_s, 0.08);
}

TEST_F(CarriedCamera, AnObjectThatIsNotSeenStaysWhereItIsInTheWorld) {
  double error_m[2];
  for (const bool is_fixed : {false, true}) {
    setFrames("", is_fixed ? "world" : "");
    session_.reset();
    tf_.clear();
    initialise();
    constexpr int kHiddenFrom = 40, kHiddenTo = 70;
    FrameOutcome outcome;
    for (int frame = 0; frame < kHiddenTo; ++frame) outcome = step(frame, frame >= kHiddenFrom);
    error_m[is_fixed ? 1 : 0] = errorM(outcome, kHiddenTo - 1);
  }
  EXPECT_LT(error_m[1], 0.02);
  EXPECT_GT(error_m[0], 2.0 * error_m[1]);
}

TEST_F(CarriedCamera, APoseOfSomeTimeAgoIsTakenToTheImage) {
  setFrames("", "world");
  sendTransform(time(0));
  sendTransform(time(30));
  InitialPose pose;  // as a detector in the camera saw it a second ago
  pose.frame_id = kCamera;
  pose.stamp = ros::Time(time(0));
  pose.T_frame_object = cameraInWorld(time(0)).inverse() * truthInWorld();
  session_.initialise(pose, nullptr);
  FrameOutcome outcome;
  for (int frame = 30; frame < 36; ++frame) outcome = step(frame);
  EXPECT_EQ(outcome.result.state, TrackerState::kTracking) << outcome.result.reason;
  EXPECT_LT(errorM(outcome, 35), 0.002);
}

TEST_F(CarriedCamera, AnImageFromAnUnknownPlaceIsRefusedAndTrackingGoesOn) {
  setFrames("", "world");
  initialise();
  for (int frame = 0; frame < 20; ++frame) step(frame);
  for (int frame = 20; frame < 23; ++frame) {
    const FrameOutcome outcome = process(frame);
    EXPECT_FALSE(outcome.processed);
    EXPECT_NE(outcome.result.reason.find("tf cannot place '" + kCamera + "' in 'world'"), std::string::npos)
        << outcome.result.reason;
  }
  FrameOutcome outcome;
  for (int frame = 23; frame < 28; ++frame) outcome = step(frame);
  EXPECT_EQ(outcome.result.state, TrackerState::kTracking) << outcome.result.reason;
  EXPECT_LT(errorM(outcome, 27), 0.002);
}

TEST_F(CarriedCamera, ATransformThatIsALittleLateIsWaitedFor) {
  setFrames("", "world", 20.0);
  initialise();
  for (int frame = 0; frame < 5; ++frame) step(frame);
  std::thread late([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    sendTransform(time(5));
  });
  EXPECT_TRUE(process(5).processed);
  late.join();
}

TEST_F(CarriedCamera, AFrameThatNobodyKnowsIsNotWaitedFor) {
  setFrames("no_such_frame", "", 3600.0);
  initialise();
  const FrameOutcome outcome = step(0);
  EXPECT_TRUE(outcome.processed);
  EXPECT_NE(outcome.output.problem.find("no_such_frame"), std::string::npos) << outcome.output.problem;
}

TEST_F(CarriedCamera, OutputInTheTargetFrame) {
  for (const char* fixed : {"", "world"}) {
    setFrames("world", fixed);
    session_.reset();
    tf_.clear();
    initialise();
    FrameOutcome outcome;
    for (int frame = 0; frame < 30; ++frame) outcome = step(frame);
    ASSERT_EQ(outcome.output.problem, "");
    EXPECT_EQ(outcome.output_frame, "world");
    const TrackerResult told = toFrame(outcome.result, outcome.output.T_target_source);
    EXPECT_LT(difference(told.T_camera_object, truthInWorld()).head<3>().norm(), 0.002) << fixed;
    EXPECT_LT(difference(told.T_camera_object, truthInWorld()).tail<3>().norm(), 0.02) << fixed;
    // Depth is along the camera's z; the uncertainty keeps its size and turns with the axes.
    EXPECT_NEAR(told.covariance.trace(), outcome.result.covariance.trace(), 1e-12);
    const Eigen::Vector3d z_world = outcome.output.T_target_source.linear().col(2);
    EXPECT_NEAR(z_world.dot(told.covariance.topLeftCorner<3, 3>() * z_world), outcome.result.covariance(2, 2), 1e-12);
    EXPECT_NEAR(told.twist.norm(), outcome.result.twist.norm(), 1e-9);
  }
}

TEST(ToFrame, CovarianceTurnsByTheRotationAndKeepsItsCrossTerms) {
  TrackerResult result;
  result.covariance.setZero();
  result.covariance.diagonal() << 1, 2, 3, 4, 5, 6;
  result.covariance(0, 4) = result.covariance(4, 0) = 0.5;
  result.twist << 1, 0, 0, 0, 2, 0;
  Pose T_target_camera = Pose::Identity();
  T_target_camera.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;  // x becomes y, y becomes -x
  T_target_camera.translation() = Eigen::Vector3d(7, 8, 9);
  const TrackerResult told = toFrame(result, T_target_camera);
  Vector6d variances, twist;
  variances << 2, 1, 3, 5, 4, 6;
  twist << 0, 1, 0, -2, 0, 0;
  EXPECT_TRUE(told.covariance.diagonal().isApprox(variances));
  EXPECT_DOUBLE_EQ(told.covariance(1, 3), -0.5);
  EXPECT_TRUE(told.twist.isApprox(twist));
  EXPECT_TRUE(told.T_camera_object.isApprox(T_target_camera));
}

}  // namespace
}  // namespace depth_object_tracker
