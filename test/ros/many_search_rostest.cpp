// SPDX-License-Identifier: BSD-3-Clause
// track_many.launch without a single pose: the objects of the list are searched for, two of the same mesh are found on
// two things, and all of it happens again when the nodelet manager has died.
#include <gtest/gtest.h>

#include "crossing_camera.h"
#include "node_process.h"
#include "rostest_main.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace depth_object_tracker {
namespace {

constexpr double kSearchPatienceS = 240.0 * kSlowness;
constexpr double kNearM = 0.05;  // a mug whose handle is turned wrongly is still the right mug

/// Three things that stand still, none of them much hidden, seen by a camera that goes on whatever happens to the
/// trackers.
class StillScene {
 public:
  StillScene()
      : scene_({loadMesh(packageMesh("drill")), loadMesh(packageMesh("mug")), loadMesh(packageMesh("mug"))}, config_),
        images_(node_.advertise<sensor_msgs::Image>("/camera/depth/image_raw", 2)),
        infos_(node_.advertise<sensor_msgs::CameraInfo>("/camera/depth/camera_info", 2)) {
    double best = -1.0;
    for (double time_s = 0.0; time_s < 20.0; time_s += 0.5) {
      const CrossingFrame& frame = scene_.render(time_s);
      const double worst = *std::min_element(frame.visible_fraction.begin(), frame.visible_fraction.end());
      if (worst > best) {
        best = worst;
        time_s_ = time_s;
      }
    }
    std::printf("at %.1f s of the scene every object is visible by %.0f %% at least\n", time_s_, 100.0 * best);
  }

  Eigen::Vector3d place(std::size_t object) const { return scene_.truth(object, time_s_).translation(); }
  ros::Time stamp() const { return stamp_; }

  void step() {
    stamp_ += ros::Duration(1.0 / 30.0);
    const CrossingFrame& frame = scene_.render(time_s_);  // new noise each time
    const auto image = makeCrossingImage(frame, config_.camera);
    const auto info = makeCameraInfo(config_.camera);
    info->header.stamp = image->header.stamp = stamp_;
    infos_.publish(info);
    images_.publish(image);
    ros::WallDuration(0.1).sleep();
  }

 private:
  CrossingSceneConfig config_;
  CrossingScene scene_;
  ros::NodeHandle node_;
  ros::Publisher images_, infos_;
  double time_s_ = 0.0;
  ros::Time stamp_{1000.0};
};

class Watched {
 public:
  explicit Watched(const std::string& name)
      : status_(ros::NodeHandle(), "/tracker/" + name + "/status"),
        pose_(ros::NodeHandle(), "/tracker/" + name + "/pose") {}

  /// Where the object is said to be in an image after `since`, if it is tracked.
  std::optional<Eigen::Vector3d> place(const ros::Time& since) const {
    const auto pose = pose_.newest();
    const auto status = status_.newest();
    if (!pose || !status || pose->header.stamp <= since || status->state != TrackerStatus::TRACKING)
      return std::nullopt;
    const auto& p = pose->pose.pose.position;
    return Eigen::Vector3d(p.x, p.y, p.z);
  }
  std::string reason() const { return status_.newest() ? status_.newest()->reason : "no status"; }

 private:
  Recorder<TrackerStatus> status_;
  Recorder<geometry_msgs::PoseWithCovarianceStamped> pose_;
};

bool areNear(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return (a - b).norm() < kNearM;
}

/// The two mugs cannot be told apart: either tracker may have either.
bool allAreFound(StillScene& scene, const Watched& drill, const Watched& one_mug, const Watched& other_mug) {
  const ros::Time since = scene.stamp();
  return waitUntil(
      [&] {
        scene.step();
        const auto at_drill = drill.place(since), at_one = one_mug.place(since), at_other = other_mug.place(since);
        if (!at_drill || !at_one || !at_other) return false;
        const bool are_in_order = areNear(*at_one, scene.place(1)) && areNear(*at_other, scene.place(2));
        const bool are_exchanged = areNear(*at_one, scene.place(2)) && areNear(*at_other, scene.place(1));
        return areNear(*at_drill, scene.place(0)) && (are_in_order || are_exchanged);
      },
      kSearchPatienceS);
}

TEST(ManySearch, ObjectsAreFoundAtTheStartAndAgainWhenTheManagerHasDied) {
  const Watched drill("drill"), one_mug("one_mug"), other_mug("other_mug");
  StillScene scene;
  const auto reasons = [&] { return drill.reason() + " | " + one_mug.reason() + " | " + other_mug.reason(); };
  ASSERT_TRUE(allAreFound(scene, drill, one_mug, other_mug)) << reasons();
  const int first = processOf("/tracker_manager");
  ASSERT_TRUE(killNode("/tracker_manager"));
  EXPECT_TRUE(waitUntil([&] { return processOf("/tracker_manager") > 0 && processOf("/tracker_manager") != first; }));
  EXPECT_TRUE(allAreFound(scene, drill, one_mug, other_mug)) << reasons();
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  return runRosTests(argc, argv, "many_search_rostest");
}
