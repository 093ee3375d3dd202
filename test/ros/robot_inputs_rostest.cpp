// SPDX-License-Identifier: BSD-3-Clause
// A running tracker and a robot: several drivers, clocks that differ, commands, and how a grasp is noticed.
#include "robot_fixture.h"
#include "rostest_main.h"

#include <depth_object_tracker/Grasp.h>

namespace depth_object_tracker {
namespace {

using RobotInputs = RobotFixture;

TEST_F(RobotInputs, SeveralDriversReportPartsOfTheArmByAnotherClock) {
  constexpr double kAheadS = 0.5;
  setParameter("joint_time_offset_s", kAheadS);
  start(armText());
  ros::Publisher wrist = node_.advertise<sensor_msgs::JointState>("/joint_states", 1000);
  ASSERT_TRUE(waitUntil([&] { return wrist.getNumSubscribers() > 0; }));
  const auto publish = [&](double until_s) {
    for (; joints_until_s_ < until_s + kJointPeriodS; joints_until_s_ += kJointPeriodS) {
      const sensor_msgs::JointState all = arm_.jointStates(joints_until_s_);
      sensor_msgs::JointState parts[2];
      for (std::size_t k = 0; k < all.name.size(); ++k) {
        sensor_msgs::JointState& part = parts[k < 3 ? 0 : 1];
        part.header.stamp = all.header.stamp + ros::Duration(kAheadS);
        part.name.push_back(all.name[k]);
        part.position.push_back(all.position[k]);
      }
      joints_.publish(parts[0]);
      wrist.publish(parts[1]);
    }
    publishTf(until_s + kAheadS);
  };
  const auto publishAndStep = [&](bool is_seen) {
    publish(nextStamp());
    return is_seen ? stepImage(arm_.T_camera_object(nextStamp())) : stepUnseen();
  };
  ASSERT_TRUE(grasp("hand_link").success);
  for (int k = 0; k < 10; ++k) publishAndStep(true);
  EXPECT_TRUE(waitUntil([&] { return slips_->size() > 0; }));  // the hand is followed
  const double hidden_from_s = harness_->stamp().toSec();
  for (int k = 0; k < 15; ++k) EXPECT_LT(publishAndStep(false), 0.004) << k;
  EXPECT_GT(travelledM(hidden_from_s, harness_->stamp().toSec()), 0.02);
}

TEST_F(RobotInputs, FollowsCommandedVelocities) {
  setParameter("control_source", "commands");
  start(armText());
  ros::Publisher commands = node_.advertise<sensor_msgs::JointState>("/joint_commands", 1000);
  ASSERT_TRUE(waitUntil([&] { return commands.getNumSubscribers() > 0; }));
  double commands_until_s = kBeginS - 0.1;
  const auto publishAndStep = [&](bool is_seen) {
    for (; commands_until_s < nextStamp(); commands_until_s += kJointPeriodS) {
      sensor_msgs::JointState command = arm_.jointStates(commands_until_s);
      command.position.clear();
      commands.publish(command);
    }
    publishJoints(nextStamp());
    publishTf(nextStamp());
    return is_seen ? stepImage(arm_.T_camera_object(nextStamp())) : stepUnseen();
  };
  ASSERT_TRUE(grasp("hand_link").success);
  for (int k = 0; k < 10; ++k) publishAndStep(true);
  for (int k = 0; k < 15; ++k) EXPECT_LT(publishAndStep(false), 0.005) << k;
  EXPECT_EQ(static_cast<int>(last_status_.state), static_cast<int>(TrackerStatus::OCCLUDED)) << last_status_.reason;
}

TEST_F(RobotInputs, ALatchedGraspOfBeforeTheStartCounts) {
  ros::Publisher grasps = node_.advertise<Grasp>("/grasp", 1, true);
  Grasp message;
  message.grasped = true;
  message.link = "hand_link";
  grasps.publish(message);
  start(armText());
  EXPECT_TRUE(waitUntil([&] {
    step();
    return last_status_.grasped && slips_->size() > 0;
  }));
}

TEST_F(RobotInputs, NoticesThatTheGripperHasClosedAboutTheObject) {
  setParameter("grasp_detection/link", "hand_link");
  setParameter("grasp_detection/joint", "finger_3_joint");
  setParameter("grasp_detection/open_position", 0.0);
  setParameter("grasp_detection/closed_position", 1.5);
  start(armText());
  for (const bool closed : {true, false}) {
    EXPECT_TRUE(waitUntil([&] {
      sensor_msgs::JointState gripper;
      gripper.header.stamp = ros::Time(nextStamp());
      gripper.name = {"finger_3_joint"};
      gripper.position = {closed ? 0.9 : 0.01};
      joints_.publish(gripper);
      EXPECT_LT(step(), 0.006);
      return static_cast<bool>(last_status_.grasped) == closed;
    }));
  }
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  return runRosTests(argc, argv, "robot_inputs_rostest");
}
