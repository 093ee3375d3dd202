// SPDX-License-Identifier: BSD-3-Clause
// track.launch with respawn: the nodelet manager dies, as it does when a driver in it crashes, also at the worst
// moment; or what loads the tracker dies. The tracker comes back, and takes up the last pose.
#include <gtest/gtest.h>

#include "node_process.h"
#include "rostest_main.h"
#include "tracker_harness.h"

#include <bond/Status.h>

#include <atomic>
#include <fstream>
#include <string>

namespace depth_object_tracker {
namespace {

/// A camera that goes on whatever happens to the tracker.
class Camera {
 public:
  Camera()
      : images_(node_.advertise<sensor_msgs::Image>("/camera/depth/image_raw", 2)),
        infos_(node_.advertise<sensor_msgs::CameraInfo>("/camera/depth/camera_info", 2)),
        statuses_(node_, "/tracker/status"),
        poses_(node_, "/tracker/pose") {}

  void step() {
    stamp_ += ros::Duration(1.0 / 30.0);
    const auto info = makeCameraInfo(testCamera());
    const auto image = makeUint16Image(scene_.depth(testPose()), testCamera().width, testCamera().height);
    info->header.stamp = image->header.stamp = stamp_;
    infos_.publish(info);
    images_.publish(image);
    ros::WallDuration(0.05).sleep();
  }

  /// Steps until a new pose says where the object is.
  bool comesToTrack() {
    const ros::Time before = stamp_;
    return waitUntil(
        [&] {
          step();
          const auto pose = poses_.newest();
          const auto status = statuses_.newest();
          if (!pose || pose->header.stamp <= before || status->state != TrackerStatus::TRACKING) return false;
          const auto& p = pose->pose.pose.position;
          return (Eigen::Vector3d(p.x, p.y, p.z) - testPose().translation()).norm() < 0.005;
        },
        240.0);
  }
  const Recorder<TrackerStatus>& statuses() const { return statuses_; }

 private:
  ros::NodeHandle node_;
  ros::Publisher images_, infos_;
  Recorder<TrackerStatus> statuses_;
  Recorder<geometry_msgs::PoseWithCovarianceStamped> poses_;
  TestScene scene_;
  ros::Time stamp_{1000.0};
};

/// Waits until `node` has sent its first heartbeat, and not its second: a bond that has heard just one never breaks by
/// itself, whatever happens to the other end.
bool firstHeartbeatComes(const std::string& node) {
  std::atomic<bool> has_come{false};
  const boost::function<void(const ros::MessageEvent<const bond::Status>&)> look =
      [&](const ros::MessageEvent<const bond::Status>& event) {
        has_come = has_come || event.getPublisherName() == node;
      };
  ros::SubscribeOptions options;
  options.initByFullCallbackType<const ros::MessageEvent<const bond::Status>&>("/tracker_manager/bond", 100, look);
  const ros::Subscriber subscriber = ros::NodeHandle().subscribe(options);
  return waitUntil([&] { return has_come.load(); });
}

/// Kills a node and waits until it has been started again.
bool killAndSeeItReturn(const std::string& node) {
  const int process = processOf(node);
  if (!killNode(node)) return false;
  return waitUntil([&] { return processOf(node) > 0 && processOf(node) != process; });
}

bool fileComes(const std::string& file) {
  return waitUntil([&] { return std::ifstream(file).good(); });
}

TEST(TrackRespawn, TheTrackerOutlivesItsManager) {
  std::string last_pose_file;
  ASSERT_TRUE(ros::param::get("/tracker/last_pose_file", last_pose_file));
  Camera camera;
  // Nobody gives a pose: `init` is search.
  ASSERT_TRUE(camera.comesToTrack()) << (camera.statuses().newest() ? camera.statuses().newest()->reason : "no status");
  ASSERT_TRUE(fileComes(last_pose_file));
  ASSERT_TRUE(killAndSeeItReturn("/tracker_manager"));
  ASSERT_TRUE(firstHeartbeatComes("/tracker_manager"));
  ASSERT_TRUE(killAndSeeItReturn("/tracker_manager"));
  EXPECT_TRUE(camera.comesToTrack()) << camera.statuses().newest()->reason;
}

/// What was loaded is still there then, under the same name.
TEST(TrackRespawn, TheTrackerOutlivesItsLoader) {
  Camera camera;
  ASSERT_TRUE(killAndSeeItReturn("/tracker"));
  const std::size_t num_statuses = camera.statuses().size();
  const auto isNew = [&] {
    const auto statuses = camera.statuses().messages();
    for (std::size_t i = num_statuses; i < statuses.size(); ++i) {
      if (statuses[i]->frames_received < 3) return true;
    }
    return false;
  };
  ASSERT_TRUE(waitUntil(isNew)) << "no tracker that begins to count images";
  EXPECT_TRUE(camera.comesToTrack()) << camera.statuses().newest()->reason;
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  return runRosTests(argc, argv, "track_respawn_rostest");
}
