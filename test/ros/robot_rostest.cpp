// SPDX-License-Identifier: BSD-3-Clause
// A running tracker and a robot: what it takes from joints, tf and the URDF, and what it says when they are wrong.
#include "robot_fixture.h"
#include "rostest_main.h"

#include <depth_object_tracker/Grasp.h>

namespace depth_object_tracker {
namespace {

using Robot = RobotFixture;

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
