// SPDX-License-Identifier: BSD-3-Clause
// Bad parameters: the nodelet lives on, says what is wrong, and can be mended.
#include <gtest/gtest.h>

#include "rostest_main.h"
#include "tracker_harness.h"

#include <depth_object_tracker/LoadObject.h>

namespace depth_object_tracker {
namespace {

/// Loads a nodelet whose parameters are bad; checks that it says so.
void expectUninitialized(TrackerHarness& tracker, const std::vector<std::string>& parts) {
  ASSERT_TRUE(tracker.isReady());
  const TrackerStatus status = tracker.step();
  EXPECT_EQ(static_cast<int>(status.state), static_cast<int>(TrackerStatus::UNINITIALIZED));
  for (const auto& part : parts)
    EXPECT_NE(status.reason.find(part), std::string::npos) << part << " is not in: " << status.reason;
  EXPECT_TRUE(tracker.waitForLog(parts));
  EXPECT_FALSE(tracker.initialise());
  EXPECT_EQ(tracker.poses().size(), 0u);
}

/// After the parameters were set right.
void expectMended(TrackerHarness& tracker) {
  LoadObject call;
  ASSERT_TRUE(ros::service::call(tracker.name() + "/load_object", call));
  EXPECT_TRUE(call.response.success) << call.response.message;
  EXPECT_TRUE(tracker.initialise());
  tracker.expectTracking();
}

TEST(BadStart, MissingMeshFile) {
  const std::string name = "/tracker_missing_mesh";
  setGoodParameters(name);
  ros::param::set(name + "/mesh", "/no/such/mesh.obj");
  TrackerHarness tracker(name);
  expectUninitialized(tracker, {"/no/such/mesh.obj"});
  ros::param::set(name + "/mesh", testMeshFile());
  expectMended(tracker);
}

TEST(BadStart, AbsurdMeshScale) {
  const std::string name = "/tracker_absurd_mesh";
  setGoodParameters(name);
  ros::param::set(name + "/mesh_scale", 1000.0);
  TrackerHarness tracker(name);
  expectUninitialized(tracker, {"bracket.obj"});
  ros::param::set(name + "/mesh_scale", 1);
  expectMended(tracker);
}

TEST(BadStart, NoObject) {
  const std::string name = "/tracker_no_object";
  setGoodParameters(name);
  ros::param::del(name + "/mesh");
  TrackerHarness tracker(name);
  expectUninitialized(tracker, {"~object_file", "~load_object"});
  ros::param::set(name + "/mesh", testMeshFile());
  expectMended(tracker);
}

TEST(BadStart, UnknownAndOutOfRangeParameters) {
  const std::string name = "/tracker_bad_parameters";
  setGoodParameters(name);
  ros::param::set(name + "/tracker/num_partcles", 100);
  ros::param::set(name + "/tracker/tail_weight", 7.5);
  ros::param::set(name + "/publish_tf", "perhaps");
  TrackerHarness tracker(name);
  expectUninitialized(tracker, {"num_partcles", "num_particles", "tail_weight", "7.5", name + "/publish_tf"});
  ros::param::del(name + "/tracker/num_partcles");
  ros::param::set(name + "/tracker/tail_weight", 0.01);
  expectMended(tracker);
}

TEST(BadStart, MissingInitFile) {
  const std::string name = "/tracker_missing_init";
  setGoodParameters(name);
  ros::param::set(name + "/init_file", "/no/such/init.json");
  TrackerHarness tracker(name);
  ASSERT_TRUE(tracker.isReady());
  EXPECT_NE(tracker.step().reason.find("/no/such/init.json"), std::string::npos) << tracker.status()->reason;
  EXPECT_TRUE(tracker.initialise());
  tracker.expectTracking();
}

TEST(BadStart, UnknownImageTransport) {
  const std::string name = "/tracker_bad_transport";
  setGoodParameters(name);
  ros::param::set(name + "/image_transport", "pigeon");
  TrackerHarness tracker(name);
  ASSERT_TRUE(tracker.isReady());
  EXPECT_TRUE(tracker.waitForLog({"pigeon"}));
  EXPECT_TRUE(tracker.initialise());
  tracker.expectTracking();
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  return runRosTests(argc, argv, "tracker_bad_start_rostest");
}
