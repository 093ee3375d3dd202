// SPDX-License-Identifier: BSD-3-Clause
// A running tracker and a robot: what it takes from joints, tf and the URDF, and what it says when they are wrong.
#include "rostest_main.h"
#include "swinging_arm.h"
#include "tracker_harness.h"

#include <depth_object_tracker/Grasp.h>
#include <depth_object_tracker/SetGrasp.h>
#include <depth_object_tracker/Slip.h>
#include <gtest/gtest.h>
#include <tf2_ros/transform_broadcaster.h>

#include <fstream>
#include <iterator>
#include <memory>

namespace depth_object_tracker {
namespace {

constexpr double kBeginS = 1000.0;
constexpr double kJointPeriodS = 0.004;

class Robot : public testing::Test {
 protected:
  Robot() : arm_(kBeginS), joints_(node_.advertise<sensor_msgs::JointState>("/joint_states", 1000)) {}

  /// Every test has a tracker of its own: what one has heard is not what the other knows.
  void start(const std::string& urdf) {
    const std::string name = std::string("/") + testing::UnitTest::GetInstance()->current_test_info()->name();
    setGoodParameters(name);
    ros::param::set(name + "/robot", true);
    ros::param::set(name + "/control_wait_s", 1.0);
    ros::param::set("/robot_description", urdf);
    harness_ = std::make_unique<TrackerHarness>(name);
    ASSERT_TRUE(harness_->isReady());
    slips_ = std::make_unique<Recorder<Slip>>(node_, name + "/slip");
    corrections_ =
        std::make_unique<Recorder<geometry_msgs::PoseWithCovarianceStamped>>(node_, name + "/kinematic_correction");
    ASSERT_TRUE(waitUntil(
        [&] { return slips_->isConnected() && corrections_->isConnected() && joints_.getNumSubscribers() > 0; }));
    harness_->setStamp(ros::Time(kBeginS));
    ASSERT_TRUE(harness_->initialise(arm_.T_camera_object(kBeginS)));
  }

  static std::string armText() {
    std::ifstream file(armFile());
    return {std::istreambuf_iterator<char>(file), {}};
  }

  SetGrasp::Response grasp(const std::string& link) {
    SetGrasp call;
    call.request.grasped = !link.empty();
    call.request.link = link;
    EXPECT_TRUE(ros::service::call(harness_->name() + "/set_grasp", call));
    return call.response;
  }

  double nextStamp() const { return harness_->stamp().toSec() + 1.0 / 30.0; }

  void publishJoints(double until_s, const std::string& prefix = "") {
    for (; joints_until_s_ < until_s + kJointPeriodS; joints_until_s_ += kJointPeriodS) {
      sensor_msgs::JointState message = arm_.jointStates(joints_until_s_);
      for (std::string& name : message.name) name = prefix + name;
      joints_.publish(message);
    }
  }

  /// @param T_camera_world the camera may have moved since the beginning.
  void publishTf(double stamp_s, const Pose& T_camera_world = Pose::Identity()) {
    geometry_msgs::TransformStamped transform = arm_.cameraTransform();
    transform.header.stamp = ros::Time(stamp_s);
    transform.transform = toTransformMessage((T_camera_world * arm_.T_camera_base()).inverse());
    broadcaster_.sendTransform(transform);
  }

  /// One image with its joints and tf. @return how far off the pose is.
  double step(const Pose& T_hand_slipped = Pose::Identity(), const Pose& T_camera_world = Pose::Identity()) {
    const double stamp_s = nextStamp();
    publishJoints(stamp_s);
    publishTf(stamp_s, T_camera_world);
    return stepImage(T_camera_world * arm_.T_camera_hand(stamp_s) * T_hand_slipped * arm_.T_hand_object());
  }

  double stepImage(const Pose& T_camera_object) {
    last_status_ = harness_->step(T_camera_object);
    if (!waitUntil([&] {
          return harness_->poses().newest() && harness_->poses().newest()->header.stamp == harness_->stamp();
        })) {
      ADD_FAILURE() << "no pose at " << harness_->stamp() << ": " << last_status_.reason;
      return 1.0;
    }
    const auto& p = harness_->poses().newest()->pose.pose.position;
    return (Eigen::Vector3d(p.x, p.y, p.z) - T_camera_object.translation()).norm();
  }

  void settle() {
    for (int k = 0; k < 10; ++k) step();
    EXPECT_LT(step(), 0.003);
  }

  ros::NodeHandle node_;
  SwingingArm arm_;
  ros::Publisher joints_;
  tf2_ros::TransformBroadcaster broadcaster_;
  std::unique_ptr<TrackerHarness> harness_;
  std::unique_ptr<Recorder<Slip>> slips_;
  std::unique_ptr<Recorder<geometry_msgs::PoseWithCovarianceStamped>> corrections_;
  TrackerStatus last_status_;
  double joints_until_s_ = kBeginS - 0.1;
};

TEST_F(Robot, GraspSwitchesWithoutAJump) {
  start(armText());
  settle();
  EXPECT_EQ(slips_->size(), 0u);
  for (int turn = 0; turn < 2; ++turn) {
    const auto held = grasp("hand_link");
    EXPECT_TRUE(held.success) << held.message;
    for (int k = 0; k < 12; ++k) EXPECT_LT(step(), 0.003);
    EXPECT_TRUE(last_status_.grasped);
    EXPECT_TRUE(grasp("").success);
    for (int k = 0; k < 6; ++k) EXPECT_LT(step(), 0.003);
    EXPECT_FALSE(last_status_.grasped);
  }
  ASSERT_TRUE(waitUntil([&] { return slips_->size() >= 20 && corrections_->size() >= 20; }));
  for (const auto& slip : slips_->messages()) {
    EXPECT_EQ(slip->header.frame_id, "hand_link");
    EXPECT_FALSE(slip->slipping);
  }
  const auto& offset = corrections_->newest()->pose.pose.position;
  EXPECT_LT(Eigen::Vector3d(offset.x, offset.y, offset.z).norm(), 0.003);  // these kinematics are right
  EXPECT_EQ(corrections_->newest()->header.frame_id, "hand_link");
}

TEST_F(Robot, TheGraspTopicNamesALinkToo) {
  start(armText());
  settle();
  ros::Publisher grasps = node_.advertise<Grasp>("/grasp", 1, true);
  Grasp message;
  message.grasped = true;
  message.link = "hand_link";
  grasps.publish(message);
  EXPECT_TRUE(waitUntil([&] {
    step();
    return last_status_.grasped && slips_->size() > 0;
  }));
  message.link = "third_hand";
  grasps.publish(message);
  EXPECT_TRUE(harness_->waitForLog({"third_hand", "hand_link"}));
  message.grasped = false;
  grasps.publish(message);
  EXPECT_TRUE(waitUntil([&] {
    step();
    return !last_status_.grasped;
  }));
}

TEST_F(Robot, SaysWhenTheObjectSlips) {
  start(armText());
  settle();
  ASSERT_TRUE(grasp("hand_link").success);
  for (int k = 0; k < 20; ++k) step();
  const auto isSlipping = [&] { return slips_->newest() && slips_->newest()->slipping; };
  EXPECT_FALSE(isSlipping());
  bool has_slipped = false;
  for (int k = 1; k <= 20; ++k) {  // 0.06 m/s along the fingers
    EXPECT_LT(step(Pose(Eigen::Translation3d(0.0, 0.0, 0.002 * k))), 0.004);
    has_slipped = has_slipped || isSlipping();
  }
  EXPECT_TRUE(has_slipped);
  EXPECT_TRUE(waitUntil([&] {
    step(Pose(Eigen::Translation3d(0.0, 0.0, 0.04)));
    return !isSlipping();
  }));
  const auto& hand_object = slips_->newest()->hand_object.pose.position;
  EXPECT_NEAR(hand_object.z, arm_.T_hand_object().translation().z() + 0.04, 0.015);
}

TEST_F(Robot, GoesOnWithStaleJointsAndNamesThem) {
  start(armText());
  settle();
  ASSERT_TRUE(grasp("hand_link").success);
  for (int k = 0; k < 5; ++k) step();
  for (int k = 0; k < 10; ++k) {  // the driver has died; the arm goes on moving
    const double stamp_s = nextStamp();
    publishTf(stamp_s);
    EXPECT_LT(stepImage(arm_.T_camera_object(stamp_s)), 0.004);
  }
  EXPECT_TRUE(harness_->waitForLog({"joint 'joint_1' was last reported", "wider noise"}));
  EXPECT_EQ(static_cast<int>(last_status_.state), static_cast<int>(TrackerStatus::TRACKING)) << last_status_.reason;
  joints_until_s_ = nextStamp() - 0.05;
  const std::size_t before = slips_->size();
  for (int k = 0; k < 10; ++k) EXPECT_LT(step(), 0.004);
  EXPECT_TRUE(waitUntil([&] { return slips_->size() > before; }));  // the hand is followed again
}

TEST_F(Robot, NamesJointsThatNobodyReports) {
  start(armText());
  ASSERT_TRUE(grasp("hand_link").success);
  for (int k = 0; k < 8; ++k) {
    const double stamp_s = nextStamp();
    publishJoints(stamp_s, "wam/");
    publishTf(stamp_s);
    stepImage(arm_.T_camera_object(stamp_s));
  }
  EXPECT_TRUE(harness_->waitForLog({"joint 'joint_4' was never reported", "joint_states name", "'wam/joint_4'"}));
  EXPECT_EQ(static_cast<int>(last_status_.state), static_cast<int>(TrackerStatus::TRACKING)) << last_status_.reason;
}

TEST_F(Robot, TracksWithoutARobotWhenItsUrdfDoesNotParse) {
  start("<robot name='broken'><link name='a'>");
  EXPECT_TRUE(harness_->waitForLog({"there is no robot", "/robot_description"}));
  const auto refused = grasp("hand_link");
  EXPECT_FALSE(refused.success);
  EXPECT_NE(refused.message.find("/robot_description"), std::string::npos) << refused.message;
  settle();
  EXPECT_FALSE(last_status_.grasped);
}

TEST_F(Robot, RefusesALinkThatTheRobotHasNot) {
  start(armText());
  const auto refused = grasp("hand");
  EXPECT_FALSE(refused.success);
  EXPECT_NE(refused.message.find("'hand'"), std::string::npos) << refused.message;
  EXPECT_NE(refused.message.find("'hand_link'"), std::string::npos) << refused.message;
}

TEST_F(Robot, GoesOnThroughAGapOfTf) {
  start(armText());
  settle();
  ASSERT_TRUE(grasp("hand_link").success);
  for (int k = 0; k < 5; ++k) step();
  for (int k = 0; k < 4; ++k) {
    const double stamp_s = nextStamp();
    publishJoints(stamp_s);
    EXPECT_LT(stepImage(arm_.T_camera_object(stamp_s)), 0.004);
  }
  EXPECT_TRUE(harness_->waitForLog({"tf does not know", "'base_link'", "'camera_depth_optical_frame'"}));
  for (int k = 0; k < 5; ++k) EXPECT_LT(step(), 0.004);
  EXPECT_EQ(static_cast<int>(last_status_.state), static_cast<int>(TrackerStatus::TRACKING)) << last_status_.reason;
}

TEST_F(Robot, ACameraMayMove) {
  start(armText());
  settle();
  ASSERT_TRUE(grasp("hand_link").success);
  for (int k = 1; k <= 20; ++k) {  // 0.3 m/s sideways and back
    const double way_m = 0.01 * (k <= 10 ? k : 20 - k);
    EXPECT_LT(step(Pose::Identity(), Pose(Eigen::Translation3d(-way_m, 0, 0))), 0.003) << k;
  }
  for (const auto& slip : slips_->messages()) EXPECT_FALSE(slip->slipping);
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  return runRosTests(argc, argv, "robot_rostest");
}
