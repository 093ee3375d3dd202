// SPDX-License-Identifier: BSD-3-Clause
// A held object follows the joints of the hand that holds it.
#include "depth_object_tracker/ros/tracker_session.h"
#include "random_pose.h"
#include "swinging_arm.h"

#include <gtest/gtest.h>
#include <tf2/buffer_core.h>

#include <fstream>
#include <iterator>
#include <sstream>

namespace depth_object_tracker {
namespace {

constexpr double kBeginS = 1000.0;
constexpr double kFrameS = 1.0 / 30.0;
constexpr double kJointPeriodS = 0.004;

class RobotSessionTest : public testing::Test {
 protected:
  RobotSessionTest() : arm_(kBeginS), session_("test", "/camera/depth/image_raw", "/camera/depth/camera_info", tf_) {
    ObjectSource source;
    source.mesh = testMeshFile();
    TrackerConfig config;
    config.filter.num_particles = 40;
    session_.setTracker(buildTracker(source, config));
  }

  void connect(const RobotConnectionConfig& config = {}) {
    session_.setRobot({std::make_shared<RobotConnection>(RobotModel::fromFile(armFile()), config, tf_), nullptr, ""});
  }
  void mountCamera() { tf_.setTransform(arm_.cameraTransform(), "test", true); }

  void initialise(const Pose& T_camera_object) {
    InitialPose pose;
    pose.T_frame_object = T_camera_object;
    session_.initialise(pose, nullptr);
  }

  void moveJointsUntil(double stamp_s) {
    for (; joints_until_s_ <= stamp_s + kJointPeriodS; joints_until_s_ += kJointPeriodS) {
      session_.addJointStates(arm_.jointStates(joints_until_s_));
    }
  }

  /// An image of the object, or one in which nothing is seen at all.
  FrameOutcome step(bool is_seen, const Pose& T_camera_object) {
    std::vector<float> depth = scene_.depth(T_camera_object);
    if (!is_seen) depth.assign(depth.size(), 0.0f);
    const auto image = makeUint16Image(depth, testCamera().width, testCamera().height);
    image->header.stamp = ros::Time(stamp_s_);
    frame_ = CameraFrame{image, makeCameraInfo(testCamera()), std::chrono::steady_clock::now()};
    const FrameOutcome outcome = session_.process(frame_);
    stamp_s_ += kFrameS;
    return outcome;
  }

  static double errorM(const FrameOutcome& outcome, const Pose& T_camera_object) {
    return (outcome.result.T_camera_object.translation() - T_camera_object.translation()).norm();
  }

  /// Sees the object for a moment, then moves it unseen for half a second.
  void expectItFollowsUnseen(double tolerance_m) {
    initialise(arm_.T_camera_object(stamp_s_));
    FrameOutcome outcome;
    for (int k = 0; k < 20; ++k) {
      const double now_s = stamp_s_;
      moveJointsUntil(now_s);
      outcome = step(k < 5, arm_.T_camera_object(now_s));
      EXPECT_LT(errorM(outcome, arm_.T_camera_object(now_s)), tolerance_m) << "frame " << k;
    }
    EXPECT_TRUE(outcome.result.grasped);
    const double travelled =
        (arm_.T_camera_object(stamp_s_).translation() - arm_.T_camera_object(kBeginS).translation()).norm();
    EXPECT_GT(travelled, 0.03);  // there was something to follow
  }

  TestScene scene_;
  SwingingArm arm_;
  tf2::BufferCore tf_;
  TrackerSession session_;
  CameraFrame frame_;
  double stamp_s_ = kBeginS;
  double joints_until_s_ = kBeginS - 0.1;
};

TEST_F(RobotSessionTest, FollowsTheHandWhileNothingIsSeen) {
  connect();
  mountCamera();
  session_.setGrasp(true, "hand_link");
  expectItFollowsUnseen(0.003);
}

TEST_F(RobotSessionTest, FollowsReportedVelocities) {
  RobotConnectionConfig config;
  config.state.control_source = ControlSource::kVelocities;
  connect(config);
  mountCamera();
  session_.setGrasp(true, "hand_link");
  expectItFollowsUnseen(0.003);
}

/// With and without a fixed frame: the camera's own motion counts once, whoever accounts for it.
class MovingCamera : public RobotSessionTest, public testing::WithParamInterface<const char*> {};

TEST_P(MovingCamera, IsPlacedByTfAtTheStamp) {
  connect();
  session_.setFrames({"", GetParam(), 0.0});
  // The camera slides along its own x axis at 0.3 m/s; the object is where the arm has it.
  const auto T_moved_camera = [](double stamp_s) {
    return Pose(Eigen::Translation3d(-0.3 * (stamp_s - kBeginS), 0, 0));
  };
  for (double t_s = kBeginS - 0.1; t_s < kBeginS + 1.0; t_s += 0.01) {
    geometry_msgs::TransformStamped transform = arm_.cameraTransform();
    transform.header.stamp = ros::Time(t_s);
    transform.transform = toTransformMessage((T_moved_camera(t_s) * arm_.T_camera_base()).inverse());
    tf_.setTransform(transform, "test", false);
  }
  session_.setGrasp(true, "hand_link");
  initialise(T_moved_camera(stamp_s_) * arm_.T_camera_object(stamp_s_));
  for (int k = 0; k < 15; ++k) {
    const Pose T_camera_object = T_moved_camera(stamp_s_) * arm_.T_camera_object(stamp_s_);
    moveJointsUntil(stamp_s_);
    EXPECT_LT(errorM(step(k < 5, T_camera_object), T_camera_object), 0.003) << "frame " << k;
  }
}

INSTANTIATE_TEST_SUITE_P(FixedFrame, MovingCamera, testing::Values("", "base_link"));

TEST_F(RobotSessionTest, ImagesFromBeforeTheJointsClockBeganAreNoError) {
  RobotConnectionConfig config;
  config.state.joint_time_offset_s = -0.5;  // simulated time begins at 0
  connect(config);
  mountCamera();
  session_.setGrasp(true, "hand_link");
  stamp_s_ = 0.1;
  step(true, arm_.T_camera_object(kBeginS));
  EXPECT_NO_THROW(session_.awaitsControl(ros::Time(0.2)));
}

TEST_F(RobotSessionTest, ACameraOfTheUrdfNeedsNoTf) {
  RobotConnectionConfig config;
  config.camera_pose_source = CameraPoseSource::kUrdf;
  std::string urdf;
  {
    std::ifstream file(armFile());
    urdf.assign(std::istreambuf_iterator<char>(file), {});
  }
  const Pose T_base_camera = arm_.T_camera_base().inverse();
  const Eigen::Vector3d ypr = T_base_camera.linear().eulerAngles(2, 1, 0);
  std::ostringstream camera;
  camera.precision(15);
  camera << "<link name='camera_depth_optical_frame'/><joint name='mount' type='fixed'><parent link='base_link'/>"
         << "<child link='camera_depth_optical_frame'/><origin xyz='" << T_base_camera.translation().transpose()
         << "' rpy='" << ypr[2] << ' ' << ypr[1] << ' ' << ypr[0] << "'/></joint></robot>";
  urdf.replace(urdf.rfind("</robot>"), 8, camera.str());
  session_.setRobot({std::make_shared<RobotConnection>(RobotModel::fromText(urdf, "test"), config, tf_), nullptr, ""});
  session_.setGrasp(true, "hand_link");
  expectItFollowsUnseen(0.003);
}

TEST_F(RobotSessionTest, GoesOnWithoutJointsOrTfOrRobot) {
  session_.setGrasp(true, "hand_link");
  EXPECT_NE(session_.findLinkProblem("hand_link").find("~robot is false"), std::string::npos);
  connect();
  session_.setGrasp(true, "no_such_link");
  EXPECT_NE(session_.findLinkProblem("no_such_link").find("'no_such_link'"), std::string::npos);
  initialise(testPose());
  for (const bool has_tf : {false, true}) {
    if (has_tf) mountCamera();
    session_.setGrasp(true, "hand_link");  // joints never come
    FrameOutcome outcome;
    for (int k = 0; k < 5; ++k) outcome = step(true, testPose());
    EXPECT_TRUE(outcome.result.grasped);
    EXPECT_EQ(outcome.result.state, TrackerState::kTracking) << outcome.result.reason;
    EXPECT_LT(errorM(outcome, testPose()), 0.003);
  }
}

TEST_F(RobotSessionTest, GraspAndReleaseDoNotJump) {
  connect();
  mountCamera();
  initialise(arm_.T_camera_object(stamp_s_));
  Vector6d twist = Vector6d::Zero();
  for (int k = 0; k < 60; ++k) {
    if (k % 15 == 5) session_.setGrasp(k % 30 == 5, "hand_link");
    const double now_s = stamp_s_;
    moveJointsUntil(now_s);
    const FrameOutcome outcome = step(true, arm_.T_camera_object(now_s));
    EXPECT_LT(errorM(outcome, arm_.T_camera_object(now_s)), 0.0025) << "frame " << k;
    EXPECT_EQ(outcome.result.state, TrackerState::kTracking) << outcome.result.reason;
    twist = outcome.result.twist;
    const Vector6d truth = difference(arm_.T_camera_object(now_s), arm_.T_camera_object(now_s - kFrameS)) / kFrameS;
    if (k < 5) continue;
    EXPECT_LT((twist - truth).head<3>().norm(), 0.05) << "frame " << k;  // of all, not of that in the hand
  }
  EXPECT_GT(twist.head<3>().norm(), 0.03);
}

TEST_F(RobotSessionTest, TellsWhereTheHandIsWhenTheKinematicsAreWrong) {
  connect();
  mountCamera();
  session_.setGrasp(true, "hand_link");
  initialise(arm_.T_camera_object(stamp_s_));
  // The cables stretch: the object drifts away from where the joints have it, by 15 mm in a second and a half.
  const auto stretched = [&](double stamp_s) {
    return Pose(Eigen::Translation3d(0.0, 0.01 * std::min(1.5, stamp_s - kBeginS), 0.0));
  };
  FrameOutcome outcome;
  Pose T_camera_link;
  for (int k = 0; k < 60; ++k) {
    const double now_s = stamp_s_;
    moveJointsUntil(now_s);
    T_camera_link = arm_.T_camera_hand(now_s);
    outcome = step(true, stretched(now_s) * arm_.T_camera_object(now_s));
  }
  ASSERT_TRUE(outcome.hand);
  const Pose T_camera_observed = outcome.hand->T_camera_link * outcome.hand->observed.T_link_observed;
  const Pose T_camera_truth = stretched(stamp_s_) * T_camera_link;
  EXPECT_LT((T_camera_observed.translation() - T_camera_truth.translation()).norm(), 0.004);
  EXPECT_GT((T_camera_link.translation() - T_camera_truth.translation()).norm(), 0.014);
  EXPECT_LT(largestDifference(T_camera_observed * outcome.hand->observed.T_link_object, outcome.result.T_camera_object),
            1e-9);
  const auto correction = toCorrectionMessage(*outcome.hand, outcome.header.stamp);
  EXPECT_EQ(correction.header.frame_id, "hand_link");
  const Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>> covariance(correction.pose.covariance.data());
  EXPECT_GT(Matrix6d(covariance).ldlt().vectorD().minCoeff(), 0.0);
  const Slip slip = toSlipMessage(*outcome.hand, outcome.header.stamp, "camera");
  EXPECT_EQ(slip.header.frame_id, "hand_link");
  EXPECT_FALSE(slip.slipping);
  EXPECT_LT((outcome.hand->observed.T_link_object.translation() - arm_.T_hand_object().translation()).norm(), 0.004);
  EXPECT_EQ(toCorrectionTransform(*outcome.hand, outcome.header.stamp).child_frame_id, "hand_link_observed");
}

TEST_F(RobotSessionTest, ItsOwnLinksDoNotDisturb) {
  const RobotModel model = RobotModel::fromFile(armFile());
  BuiltRobot robot;
  robot.connection = std::make_shared<RobotConnection>(model, RobotConnectionConfig(), tf_);
  robot.occluder = std::make_shared<RobotOccluder>(model, loadLinkMeshes(model, LinkShapes::kCollision));
  session_.setRobot(robot);
  initialise(arm_.T_camera_object(stamp_s_));
  for (int k = 0; k < 20; ++k) {  // before tf is there, and after
    if (k == 5) mountCamera();
    const double now_s = stamp_s_;
    moveJointsUntil(now_s);
    EXPECT_LT(errorM(step(true, arm_.T_camera_object(now_s)), arm_.T_camera_object(now_s)), 0.003) << "frame " << k;
  }
}

TEST_F(RobotSessionTest, DetectsAGraspByTheGrippersJoint) {
  GraspDetectorConfig detection;
  detection.link = "hand_link";
  detection.joint = "finger_3_joint";
  detection.closed_position = 1.5;
  session_.setRobot({std::make_shared<RobotConnection>(RobotModel::fromFile(armFile()), RobotConnectionConfig(), tf_),
                     std::make_shared<GraspDetector>(detection), ""});
  mountCamera();
  initialise(arm_.T_camera_object(stamp_s_));
  for (const bool closed : {false, true, false}) {
    for (int k = 0; k < 15; ++k) {
      moveJointsUntil(stamp_s_);
      sensor_msgs::JointState gripper;
      gripper.header.stamp = ros::Time(stamp_s_);
      gripper.name = {"finger_3_joint"};
      gripper.position = {closed ? 0.9 : 0.01};
      session_.addJointStates(gripper);
      step(true, arm_.T_camera_object(stamp_s_));
    }
    EXPECT_EQ(session_.grasped(), closed);
  }
}

TEST_F(RobotSessionTest, WaitsForJointsThatAreComing) {
  connect();
  mountCamera();
  session_.setGrasp(true, "hand_link");
  EXPECT_FALSE(session_.awaitsControl(ros::Time(kBeginS)));
  moveJointsUntil(kBeginS);
  initialise(testPose());
  step(true, testPose());
  EXPECT_FALSE(session_.awaitsControl(ros::Time(kBeginS)));
  EXPECT_TRUE(session_.awaitsControl(ros::Time(kBeginS + 0.03)));
  session_.setGrasp(false, "");
  EXPECT_FALSE(session_.awaitsControl(ros::Time(kBeginS + 0.03)));
}

}  // namespace
}  // namespace depth_object_tracker
