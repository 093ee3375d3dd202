// SPDX-License-Identifier: BSD-3-Clause
// The running demo: what the simulator publishes, and that the tracker follows the object.
#include "slowness.h"

#include "depth_object_tracker/ros/simulator_monitor.h"
#include "depth_object_tracker/ros/simulator_publisher.h"

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <ros/topic.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <tf2_ros/transform_listener.h>

#include <set>

namespace depth_object_tracker {
namespace {

const ros::Duration kPatience(30.0 * kSlowness);

TEST(Demo, CameraPublishesMillimetresAndItsCalibration) {
  const auto image = ros::topic::waitForMessage<sensor_msgs::Image>("/camera/depth/image_raw", kPatience);
  ASSERT_TRUE(image);
  EXPECT_EQ(image->encoding, "16UC1");
  EXPECT_EQ(image->width, 640U);
  EXPECT_EQ(image->height, 480U);
  EXPECT_EQ(image->step, 1280U);
  EXPECT_EQ(image->data.size(), 1280U * 480U);
  EXPECT_EQ(image->header.frame_id, kCameraOpticalFrame);
  const auto info = ros::topic::waitForMessage<sensor_msgs::CameraInfo>("/camera/depth/camera_info", kPatience);
  ASSERT_TRUE(info);
  EXPECT_EQ(info->width, image->width);
  EXPECT_DOUBLE_EQ(info->K[0], 525.0);
  EXPECT_DOUBLE_EQ(info->K[2], 319.5);
  EXPECT_EQ(info->header.frame_id, kCameraOpticalFrame);
}

TEST(Demo, GroundTruthMaskHasItsThreeValues) {
  const auto mask = ros::topic::waitForMessage<sensor_msgs::Image>("/ground_truth/occlusion", kPatience);
  ASSERT_TRUE(mask);
  EXPECT_EQ(mask->encoding, "mono8");
  const std::set<std::uint8_t> values(mask->data.begin(), mask->data.end());
  EXPECT_EQ(values, (std::set<std::uint8_t>{0, 128, 255})) << "the hand hides some of the object";
}

TEST(Demo, FramesLeadFromTheWorldToTheCamera) {
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  const ros::Time newest(0);
  ASSERT_TRUE(buffer.canTransform(kWorldFrame, kCameraOpticalFrame, newest, kPatience));
  const auto camera = buffer.lookupTransform(kWorldFrame, kCameraOpticalFrame, newest).transform;
  EXPECT_NEAR(camera.translation.z, 0.62, 1e-9);
  EXPECT_TRUE(buffer.canTransform(kCameraOpticalFrame, "drill", newest, kPatience))
      << "the tracker's estimate, below its object's name";
}

TEST(Demo, TrackerIsGivenOneSlightlyWrongPose) {
  const auto initial =
      ros::topic::waitForMessage<geometry_msgs::PoseWithCovarianceStamped>("/tracker/initial_pose", kPatience);
  ASSERT_TRUE(initial);
  EXPECT_EQ(initial->header.frame_id, kCameraOpticalFrame);
  EXPECT_NEAR(initial->pose.covariance[0], 0.005 * 0.005, 1e-9);
}

TEST(Demo, TrackerFollowsTheObject) {
  constexpr double kWatchS = 15.0;
  ros::NodeHandle node;
  SimulatorMonitor monitor(Symmetries{});
  const auto truth = node.subscribe("/ground_truth/pose", 100, &SimulatorMonitor::addTruth, &monitor);
  const auto estimate = node.subscribe("/tracker/pose", 100, &SimulatorMonitor::addEstimate, &monitor);
  const ros::Time end = ros::Time::now() + ros::Duration(kWatchS);
  while (ros::ok() && ros::Time::now() < end) ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.05));
  const auto summary = monitor.summary();
  // Floors that a machine shared with other work keeps as well; alone it is 30 images a second.
  EXPECT_GT(summary.images, 5.0 * kWatchS);
  EXPECT_GT(summary.estimates, 1.0 * kWatchS);
  EXPECT_EQ(summary.far_off, 0U);
  EXPECT_LT(summary.median_position_m, 0.003);
  EXPECT_LT(summary.median_rotation_rad, 0.03);
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "demo_rostest");
  const ros::NodeHandle node;  // callbacks run where a test asks for them
  ros::Time::waitForValid();   // under a sanitizer it is simulated
  return RUN_ALL_TESTS();
}
