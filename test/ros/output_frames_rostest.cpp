// SPDX-License-Identifier: BSD-3-Clause
// The tracker nodelet with ~target_frame, and with tf switched off.
#include <gtest/gtest.h>

#include "rostest_main.h"
#include "tracker_harness.h"

#include <geometry_msgs/PoseArray.h>
#include <geometry_msgs/TwistWithCovarianceStamped.h>
#include <std_srvs/Trigger.h>
#include <tf2_msgs/TFMessage.h>
#include <tf2_ros/static_transform_broadcaster.h>

namespace depth_object_tracker {
namespace {

/// The camera stands in the world, turned by a quarter about two axes.
Pose cameraInWorld() {
  Pose T_world_camera = Pose::Identity();
  T_world_camera.translation() = Eigen::Vector3d(0.5, -1.0, 1.2);
  T_world_camera.linear() = expSo3(Eigen::Vector3d(-M_PI_2, 0.0, 0.0)) * expSo3(Eigen::Vector3d(0.0, 0.0, M_PI_2));
  return T_world_camera;
}

geometry_msgs::TransformStamped cameraTransform() {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = "world";
  transform.child_frame_id = "camera_depth_optical_frame";
  transform.transform = toTransformMessage(cameraInWorld());
  return transform;
}

double distanceFromTruth(const geometry_msgs::Point& p) {
  return (Eigen::Vector3d(p.x, p.y, p.z) - (cameraInWorld() * testPose()).translation()).norm();
}

TEST(OutputFrames, PosesAreToldInTheTargetFrameOnceTfKnowsIt) {
  const std::string name = "/in_world";
  setGoodParameters(name);
  ros::param::set(name + "/target_frame", "world");
  ros::param::set(name + "/tracker/num_particles", 40);
  ros::NodeHandle node;
  TrackerHarness tracker(name);
  ASSERT_TRUE(tracker.isReady());
  ASSERT_TRUE(tracker.initialise());
  for (int i = 0; i < 5; ++i) tracker.step();
  EXPECT_TRUE(tracker.waitForLog({"no pose is published", "'world'", "'camera_depth_optical_frame'"}));
  EXPECT_EQ(tracker.poses().size(), 0u);

  Recorder<tf2_msgs::TFMessage> transforms(node, "/tf");
  Recorder<geometry_msgs::TwistWithCovarianceStamped> twists(node, name + "/twist");
  Recorder<geometry_msgs::PoseArray> particles(node, name + "/particle_poses");
  tf2_ros::StaticTransformBroadcaster broadcaster;
  broadcaster.sendTransform(cameraTransform());
  ASSERT_TRUE(waitUntil([&] {
    tracker.step();
    return tracker.poses().size() > 5 && transforms.size() > 5 && twists.size() > 5 && particles.size() > 5;
  }));
  const auto pose = tracker.poses().newest();
  EXPECT_EQ(pose->header.frame_id, "world");
  EXPECT_LT(distanceFromTruth(pose->pose.pose.position), 0.003);
  EXPECT_EQ(twists.newest()->header.frame_id, "world");
  EXPECT_EQ(particles.newest()->header.frame_id, "world");
  EXPECT_LT(distanceFromTruth(particles.newest()->poses.at(0).position), 0.02);
  const auto& transform = transforms.newest()->transforms.at(0);
  EXPECT_EQ(transform.header.frame_id, "world");
  EXPECT_EQ(transform.child_frame_id, "bracket");
  EXPECT_NEAR(transform.transform.translation.x, (cameraInWorld() * testPose()).translation().x(), 0.003);
}

TEST(OutputFrames, ImagesWaitForThePlaceOfACameraThatMoves) {
  const std::string name = "/in_fixed_frame";
  setGoodParameters(name);
  ros::param::set(name + "/fixed_frame", "world");
  TrackerHarness tracker(name);
  ASSERT_TRUE(tracker.isReady());
  const TrackerStatus refused = tracker.step();
  EXPECT_NE(refused.reason.find("tf cannot place 'camera_depth_optical_frame' in 'world'"), std::string::npos)
      << refused.reason;
  EXPECT_NE(refused.reason.find("~fixed_frame"), std::string::npos) << refused.reason;
  tf2_ros::StaticTransformBroadcaster broadcaster;
  broadcaster.sendTransform(cameraTransform());
  ASSERT_TRUE(waitUntil([&] { return tracker.step().frames_processed > 0; }));
  ASSERT_TRUE(tracker.initialise());
  tracker.expectTracking();
}

TEST(OutputFrames, TfCanBeSwitchedOff) {
  const std::string name = "/without_tf";
  setGoodParameters(name);
  ros::param::set(name + "/publish_tf", false);
  ros::NodeHandle node;
  Recorder<tf2_msgs::TFMessage> transforms(node, "/tf");
  TrackerHarness tracker(name);
  ASSERT_TRUE(tracker.isReady());
  ASSERT_TRUE(tracker.initialise());
  tracker.expectTracking();
  EXPECT_EQ(tracker.poses().newest()->header.frame_id, "camera_depth_optical_frame");
  EXPECT_EQ(transforms.size(), 0u);
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  return runRosTests(argc, argv, "output_frames_rostest");
}
