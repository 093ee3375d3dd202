// SPDX-License-Identifier: BSD-3-Clause
// Initialising by hand in rviz, by a detector's poses, and from the pose of last time.
#include <gtest/gtest.h>

#include "rostest_main.h"
#include "temporary_folder.h"
#include "tracker_harness.h"

#include <geometry_msgs/PoseStamped.h>
#include <std_srvs/Trigger.h>
#include <visualization_msgs/InteractiveMarkerFeedback.h>
#include <visualization_msgs/InteractiveMarkerInit.h>
#include <visualization_msgs/InteractiveMarkerUpdate.h>

#include <memory>

namespace depth_object_tracker {
namespace {

using visualization_msgs::InteractiveMarkerFeedback;

/// rviz's side of the interactive marker.
class FakeRviz {
 public:
  explicit FakeRviz(const std::string& nodelet)
      : updates_(node_, nodelet + "/initial_pose_marker/update"),
        publisher_(node_.advertise<InteractiveMarkerFeedback>(nodelet + "/initial_pose_marker/feedback", 10)) {}

  /// The marker as it was last inserted; null when it was erased since.
  std::shared_ptr<visualization_msgs::InteractiveMarker> marker() const {
    std::shared_ptr<visualization_msgs::InteractiveMarker> shown;
    for (const auto& update : updates_.messages()) {
      if (!update->erases.empty()) shown.reset();
      if (!update->markers.empty()) shown = std::make_shared<visualization_msgs::InteractiveMarker>(update->markers[0]);
    }
    return shown;
  }

  void drag(const geometry_msgs::Pose& pose) { send(InteractiveMarkerFeedback::POSE_UPDATE, pose, 0); }
  void chooseTrackHere(const geometry_msgs::Pose& pose) { send(InteractiveMarkerFeedback::MENU_SELECT, pose, 1); }
  bool isConnected() const { return publisher_.getNumSubscribers() > 0 && updates_.isConnected(); }

 private:
  void send(std::uint8_t event, const geometry_msgs::Pose& pose, std::uint32_t entry) {
    InteractiveMarkerFeedback feedback;
    feedback.client_id = "test";
    feedback.header.frame_id = "camera_depth_optical_frame";
    feedback.marker_name = "object";
    feedback.event_type = event;
    feedback.menu_entry_id = entry;
    feedback.pose = pose;
    publisher_.publish(feedback);
  }

  ros::NodeHandle node_;
  Recorder<visualization_msgs::InteractiveMarkerUpdate> updates_;
  ros::Publisher publisher_;
};

Pose poseOf(const geometry_msgs::Pose& message) {
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(message.position.x, message.position.y, message.position.z);
  return pose;
}

TEST(InitialPoseMarker, IsDraggedAndTracksWhereItIs) {
  const std::string name = "/tracker_marker";
  setGoodParameters(name);
  FakeRviz rviz(name);
  TrackerHarness tracker(name);
  ASSERT_TRUE(tracker.isReady());
  ASSERT_TRUE(waitUntil([&] { return rviz.isConnected(); }));
  EXPECT_FALSE(rviz.marker()) << "no image, no frame to show it in";

  tracker.step();
  ASSERT_TRUE(waitUntil([&] { return rviz.marker() != nullptr; }));
  const auto marker = rviz.marker();
  EXPECT_EQ(marker->header.frame_id, "camera_depth_optical_frame");
  EXPECT_EQ(marker->menu_entries.size(), 2u);
  EXPECT_FALSE(marker->controls.front().markers.front().points.empty()) << "the mesh";

  rviz.drag(toPoseMessage(testPose()));
  rviz.chooseTrackHere(toPoseMessage(testPose()));
  EXPECT_TRUE(waitUntil([&] { return tracker.step().state == TrackerStatus::TRACKING; }));
  tracker.expectTracking();
  EXPECT_TRUE(waitUntil([&] { return !rviz.marker(); })) << "nothing to drag while the object is tracked";

  std_srvs::Trigger call;
  ASSERT_TRUE(ros::service::call(name + "/initialize_at_marker", call));
  EXPECT_FALSE(call.response.success);
  EXPECT_NE(call.response.message.find("not shown"), std::string::npos) << call.response.message;

  ASSERT_TRUE(ros::service::call(name + "/reset", call));
  ASSERT_TRUE(waitUntil([&] { return rviz.marker() != nullptr; }));
  EXPECT_LT((poseOf(rviz.marker()->pose).translation() - testPose().translation()).norm(), 0.005)
      << "it comes back where the object was";
  ASSERT_TRUE(ros::service::call(name + "/initialize_at_marker", call));
  EXPECT_TRUE(call.response.success) << call.response.message;
  EXPECT_TRUE(waitUntil([&] { return tracker.step().state == TrackerStatus::TRACKING; }));
}

TEST(InitialPoseMarker, GarbageIsRefusedWithAReason) {
  const std::string name = "/tracker_marker_garbage";
  setGoodParameters(name);
  FakeRviz rviz(name);
  TrackerHarness tracker(name);
  ASSERT_TRUE(tracker.isReady());
  ASSERT_TRUE(waitUntil([&] { return rviz.isConnected(); }));
  tracker.step();
  ASSERT_TRUE(waitUntil([&] { return rviz.marker() != nullptr; }));
  geometry_msgs::Pose garbage;  // the quaternion is (0, 0, 0, 0)
  rviz.drag(garbage);
  rviz.chooseTrackHere(garbage);
  EXPECT_TRUE(tracker.waitForLog({"~initial_pose_marker refused", "norm 0"}));
  EXPECT_TRUE(tracker.waitForReason("norm 0"));
}

TEST(DetectedPose, IsTakenOnlyWhenThereIsNothingToLose) {
  const std::string name = "/tracker_detected";
  setGoodParameters(name);
  TrackerHarness tracker(name);
  ASSERT_TRUE(tracker.isReady());
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<geometry_msgs::PoseStamped>(name + "/detected_pose", 5);
  ASSERT_TRUE(waitUntil([&] { return publisher.getNumSubscribers() > 0; }));
  geometry_msgs::PoseStamped detection;
  detection.header.frame_id = "camera_depth_optical_frame";
  detection.pose = toPoseMessage(testPose());
  publisher.publish(detection);
  EXPECT_TRUE(waitUntil([&] { return tracker.step().state == TrackerStatus::TRACKING; }));

  detection.pose.position.x += 0.3;  // a false detection
  for (int i = 0; i < 5; ++i) publisher.publish(detection);
  tracker.expectTracking();
  detection.pose.orientation = geometry_msgs::Quaternion();
  std_srvs::Trigger call;
  ASSERT_TRUE(ros::service::call(name + "/reset", call));
  ASSERT_TRUE(tracker.waitForReason("no initial pose"));
  publisher.publish(detection);
  EXPECT_TRUE(tracker.waitForLog({"~detected_pose refused", "norm 0"}));
}

TEST(LastPose, IsTakenUpNextTime) {
  const TemporaryFolder folder;
  const std::string name = "/tracker_memory", file = (folder.path() / "sub" / "pose.json").string();
  setGoodParameters(name);
  ros::param::set(name + "/last_pose_file", file);
  {
    TrackerHarness tracker(name);
    ASSERT_TRUE(tracker.isReady());
    EXPECT_TRUE(tracker.waitForReason("no initial pose"));
    ASSERT_TRUE(tracker.initialise());
    tracker.expectTracking();
  }
  {
    TrackerHarness tracker(name);
    ASSERT_TRUE(tracker.isReady());
    tracker.expectTracking();
  }
  ros::param::set(name + "/object_name", "another");
  TrackerHarness tracker(name);
  ASSERT_TRUE(tracker.isReady());
  EXPECT_TRUE(tracker.waitForReason("no initial pose")) << "the pose was that of another object";
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  return runRosTests(argc, argv, "initial_pose_rostest");
}
