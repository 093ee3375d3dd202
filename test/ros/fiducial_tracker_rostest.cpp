// SPDX-License-Identifier: BSD-3-Clause
// The fiducial tracker as a nodelet: its pose agrees with the simulator's truth; bad pictures are said and survived.
#include "slowness.h"

#include "depth_object_tracker/ros/message_conversions.h"

#include <depth_object_tracker/TrackerStatus.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <ros/topic.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <algorithm>
#include <map>
#include <vector>

namespace depth_object_tracker {
namespace {

const ros::Duration kPatience(60.0 * kSlowness);

Eigen::Vector3d position(const geometry_msgs::Pose& pose) {
  return {pose.position.x, pose.position.y, pose.position.z};
}

TEST(FiducialTrackerNodelet, AgreesWithTheTruth) {
  ros::NodeHandle node;
  std::map<ros::Time, Eigen::Vector3d> truths, estimates;
  const auto truth = node.subscribe<geometry_msgs::PoseStamped>(
      "/ground_truth/pose", 100,
      [&](const geometry_msgs::PoseStampedConstPtr& pose) { truths[pose->header.stamp] = position(pose->pose); });
  std::string frame;
  const auto estimate = node.subscribe<geometry_msgs::PoseWithCovarianceStamped>(
      "/fiducial_tracker/pose", 100, [&](const geometry_msgs::PoseWithCovarianceStampedConstPtr& pose) {
        estimates[pose->header.stamp] = position(pose->pose.pose);
        frame = pose->header.frame_id;
        EXPECT_GT(pose->pose.covariance[0], 0.0);
      });
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(kPatience.toSec());
  while (ros::ok() && ros::WallTime::now() < end && estimates.size() < 20) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.05));
  }
  ASSERT_GE(estimates.size(), 20U);
  EXPECT_EQ(frame, "stereo_left_optical_frame");
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  ASSERT_TRUE(buffer.canTransform("camera_depth_optical_frame", frame, ros::Time(0), kPatience));
  const Pose T_camera_left =
      fromTransformMessage(buffer.lookupTransform("camera_depth_optical_frame", frame, ros::Time(0)).transform);
  EXPECT_TRUE(buffer.canTransform(frame, "box_fiducials", ros::Time(0), kPatience));
  std::vector<double> errors;
  for (const auto& [stamp, p_left] : estimates) {
    if (truths.count(stamp) > 0) errors.push_back((T_camera_left * p_left - truths[stamp]).norm());
  }
  ASSERT_GE(errors.size(), 10U);
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.004);
}

TEST(FiducialTrackerNodelet, TellsItsState) {
  const auto status = ros::topic::waitForMessage<TrackerStatus>("/fiducial_tracker/status", kPatience);
  ASSERT_TRUE(status);
  EXPECT_EQ(status->object_name, "box");
  EXPECT_NE(status->state, TrackerStatus::INITIALIZING);
}

TEST(FiducialTrackerNodelet, SaysWhatIsWrongWithAPictureAndGoesOn) {
  ros::NodeHandle node;
  auto image_left = node.advertise<sensor_msgs::Image>("/stereo/left/image_rect", 5);
  auto image_right = node.advertise<sensor_msgs::Image>("/stereo/right/image_rect", 5);
  auto info_left = node.advertise<sensor_msgs::CameraInfo>("/stereo/left/camera_info", 5);
  auto info_right = node.advertise<sensor_msgs::CameraInfo>("/stereo/right/camera_info", 5);
  bool was_told = false, went_on = false;
  const auto status =
      node.subscribe<TrackerStatus>("/fiducial_tracker/status", 50, [&](const TrackerStatusConstPtr& message) {
        was_told = was_told || message->reason.find("bayer_rggb8") != std::string::npos;
        went_on = went_on || (was_told && message->state == TrackerStatus::TRACKING && message->reason.empty());
      });
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(kPatience.toSec());
  while (ros::ok() && ros::WallTime::now() < end && !went_on) {
    sensor_msgs::Image image;
    image.header.stamp = ros::Time::now();
    image.header.frame_id = "stereo_left_optical_frame";
    image.encoding = "bayer_rggb8";
    image.width = image.height = image.step = 4;
    image.data.resize(16);
    sensor_msgs::CameraInfo info;
    info.header = image.header;
    if (!was_told) {
      info_left.publish(info);
      info_right.publish(info);
      image_left.publish(image);
      image_right.publish(image);
    }
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.1));
  }
  EXPECT_TRUE(was_told);
  EXPECT_TRUE(went_on);
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "fiducial_tracker_rostest");
  const ros::NodeHandle node;  // callbacks run where a test asks for them
  return RUN_ALL_TESTS();
}
