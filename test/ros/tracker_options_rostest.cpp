// SPDX-License-Identifier: BSD-3-Clause
// Parameters of the nodelet that switch something on or off: what is switched off is not there.
#include <gtest/gtest.h>

#include "rostest_main.h"
#include "tracker_harness.h"

#include <ros/master.h>
#include <visualization_msgs/Marker.h>

#include <algorithm>
#include <string>

namespace depth_object_tracker {
namespace {

bool isPublished(const std::string& topic) {
  ros::master::V_TopicInfo topics;
  ros::master::getTopics(topics);
  return std::any_of(topics.begin(), topics.end(), [&](const auto& info) { return info.name == topic; });
}

TEST(Options, MarkerAndDiagnosticsAreThereByDefault) {
  const std::string name = "/tracker_default";
  setGoodParameters(name);
  TrackerHarness tracker(name);
  ASSERT_TRUE(tracker.isReady());
  EXPECT_TRUE(waitUntil([] { return isPublished("/diagnostics"); }));
  EXPECT_TRUE(waitUntil([&] { return isPublished(name + "/initial_pose_marker/update"); }));
  EXPECT_TRUE(ros::service::waitForService(name + "/initialize_at_marker", 10000));
}

TEST(Options, WhatIsSwitchedOffIsNotThere) {
  const std::string name = "/tracker_plain";
  setGoodParameters(name);
  ros::param::set(name + "/publish_diagnostics", false);
  ros::param::set(name + "/interactive_marker", false);
  TrackerHarness tracker(name);
  ASSERT_TRUE(tracker.isReady());
  ASSERT_TRUE(ros::service::waitForService(name + "/initialize", 10000));
  EXPECT_FALSE(isPublished("/diagnostics"));
  EXPECT_FALSE(isPublished(name + "/initial_pose_marker/update"));
  EXPECT_FALSE(ros::service::exists(name + "/initialize_at_marker", false));
  ASSERT_TRUE(tracker.initialise());
  tracker.expectTracking();
}

TEST(Options, RvizMayReadTheMeshItself) {
  const std::string name = "/tracker_resource";
  setGoodParameters(name);
  ros::param::set(name + "/marker_use_mesh_resource", true);
  TrackerHarness tracker(name);
  ASSERT_TRUE(tracker.isReady());
  Recorder<visualization_msgs::Marker> objects(ros::NodeHandle(), name + "/object");
  ASSERT_TRUE(waitUntil([&] { return objects.size() > 0; }));
  EXPECT_EQ(objects.newest()->type, visualization_msgs::Marker::MESH_RESOURCE);
  EXPECT_EQ(objects.newest()->mesh_resource, "file://" + testMeshFile());
  EXPECT_DOUBLE_EQ(objects.newest()->scale.x, 1.0);
  EXPECT_TRUE(objects.newest()->points.empty());
}

TEST(Options, OutOfRangeIsSaidAndNothingIsTracked) {
  const std::string name = "/tracker_range";
  setGoodParameters(name);
  ros::param::set(name + "/transform_wait_s", 7.0);
  ros::param::set(name + "/control_wait_s", -1.0);
  TrackerHarness tracker(name);
  ASSERT_TRUE(tracker.isReady());
  EXPECT_TRUE(tracker.waitForLog({"/transform_wait_s' is 7; valid range is [0, 1]", "/control_wait_s' is -1"}));
  EXPECT_FALSE(tracker.initialise());
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  return runRosTests(argc, argv, "tracker_options_rostest");
}
