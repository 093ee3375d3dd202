// SPDX-License-Identifier: BSD-3-Clause
// The master goes away for good in the middle: what is connected goes on. Started by check_master_loss.py, which starts
// master and tracker, and kills the master when this says so.
#include <gtest/gtest.h>

#include "rostest_main.h"
#include "tracker_harness.h"

#include <ros/master.h>

#include <csignal>
#include <cstdlib>

namespace depth_object_tracker {
namespace {

Pose poseAt(int frame) {
  Pose T_camera_object = testPose();
  T_camera_object.translation().x() += 0.03 * std::sin(2.0 * M_PI * frame / 120.0);
  return T_camera_object;
}

TEST(MasterLoss, TrackingGoesOn) {
  ASSERT_NE(std::getenv("MASTER_PROCESS"), nullptr);
  const int master = std::atoi(std::getenv("MASTER_PROCESS"));
  ros::NodeHandle node;
  const ros::Publisher images = node.advertise<sensor_msgs::Image>("/camera/depth/image_raw", 10);
  const ros::Publisher infos = node.advertise<sensor_msgs::CameraInfo>("/camera/depth/camera_info", 10);
  const Recorder<geometry_msgs::PoseWithCovarianceStamped> poses(node, "/tracker/pose");
  const Recorder<TrackerStatus> statuses(node, "/tracker/status");
  ASSERT_TRUE(waitUntil([&] {
    return images.getNumSubscribers() > 0 && infos.getNumSubscribers() > 0 && poses.isConnected() &&
           statuses.size() > 0 && ros::service::exists("/tracker/initialize", false);
  }));
  TestScene scene;
  int frame = 0;
  const auto send = [&] {
    ++frame;
    const auto image = makeUint16Image(scene.depth(poseAt(frame)), testCamera().width, testCamera().height);
    const auto info = makeCameraInfo(testCamera());
    image->header.stamp = info->header.stamp = ros::Time(1000.0 + frame / 30.0);
    infos.publish(info);
    images.publish(image);
    return waitUntil([&] { return poses.newest() && poses.newest()->header.stamp == image->header.stamp; },
                     10.0 * kSlowness);
  };
  InitializeTracker call;
  call.request.pose.header.frame_id = "camera_depth_optical_frame";
  call.request.pose.pose.pose = toPoseMessage(poseAt(1));
  ASSERT_TRUE(ros::service::call("/tracker/initialize", call));
  ASSERT_TRUE(waitUntil(send, 30.0 * kSlowness));
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(send()) << "with the master";

  ASSERT_EQ(kill(master, SIGKILL), 0);
  ASSERT_TRUE(waitUntil([] { return !ros::master::check(); }, 30.0 * kSlowness));
  int num_good = 0;
  for (int i = 0; i < 120; ++i) {
    if (!send()) continue;
    const auto& p = poses.newest()->pose.pose.position;
    if ((Eigen::Vector3d(p.x, p.y, p.z) - poseAt(frame).translation()).norm() < 0.005) ++num_good;
  }
  EXPECT_EQ(num_good, 120) << "without the master";
  // Silence makes the tracker ask the master which topics there are.
  ros::WallDuration(6.0).sleep();
  EXPECT_TRUE(send()) << "after a silence";
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  return runRosTests(argc, argv, "master_loss_test");
}
