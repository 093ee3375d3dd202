// SPDX-License-Identifier: BSD-3-Clause
// The demo in which a robot holds the object and somebody pushes it in the hand.
#include "slowness.h"

#include "depth_object_tracker/ros/simulator_monitor.h"

#include <depth_object_tracker/Grasp.h>
#include <depth_object_tracker/Slip.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <ros/topic.h>
#include <sensor_msgs/JointState.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <set>
#include <string>
#include <vector>

namespace depth_object_tracker {
namespace {

const ros::Duration kPatience(60.0 * kSlowness);

TEST(RobotDemo, PublishesJointsAndCommands) {
  for (const char* topic : {"/joint_states", "/joint_commands"}) {
    const auto joints = ros::topic::waitForMessage<sensor_msgs::JointState>(topic, kPatience);
    ASSERT_TRUE(joints) << topic;
    const std::set<std::string> names(joints->name.begin(), joints->name.end());
    for (int k = 1; k <= 7; ++k) EXPECT_EQ(names.count("joint_" + std::to_string(k)), 1u);
    EXPECT_EQ(joints->velocity.size(), joints->name.size());
  }
  const auto grasp = ros::topic::waitForMessage<Grasp>("/grasp", kPatience);
  ASSERT_TRUE(grasp);
  EXPECT_TRUE(grasp->grasped);
  EXPECT_EQ(grasp->link, "hand_link");
}

TEST(RobotDemo, TfLeadsFromTheCameraToTheHandAndToWhereItIsObserved) {
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  EXPECT_TRUE(buffer.canTransform("camera_depth_optical_frame", "hand_link", ros::Time(0), kPatience));
  EXPECT_TRUE(buffer.canTransform("camera_depth_optical_frame", "hand_link_observed", ros::Time(0), kPatience));
}

TEST(RobotDemo, TrackerFollowsTheObjectAndSeesItSlip) {
  constexpr double kWatchS = 12.0;
  ros::NodeHandle node;
  SimulatorMonitor monitor(Symmetries{});
  std::vector<Slip> slips;
  int joint_states = 0;
  const auto truth = node.subscribe("/ground_truth/pose", 100, &SimulatorMonitor::addTruth, &monitor);
  const auto estimate = node.subscribe("/tracker/pose", 100, &SimulatorMonitor::addEstimate, &monitor);
  const auto slip =
      node.subscribe<Slip>("/tracker/slip", 100, [&](const SlipConstPtr& message) { slips.push_back(*message); });
  const auto joints = node.subscribe<sensor_msgs::JointState>(
      "/joint_states", 1000, [&](const sensor_msgs::JointStateConstPtr&) { ++joint_states; });
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(kWatchS);
  while (ros::ok() && ros::WallTime::now() < end) ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.05));
  const auto summary = monitor.summary();
  // Floors that a machine shared with other work keeps as well.
  EXPECT_GT(summary.estimates, 1.0 * kWatchS);
  EXPECT_EQ(summary.far_off, 0U);
  EXPECT_LT(summary.median_position_m, 0.003);
  EXPECT_GT(joint_states, 100.0 * kWatchS);
  EXPECT_GT(slips.size(), 1.0 * kWatchS);
  for (const Slip& message : slips) EXPECT_EQ(message.header.frame_id, "hand_link");
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "demo_robot_rostest");
  const ros::NodeHandle node;  // callbacks run where a test asks for them
  return RUN_ALL_TESTS();
}
