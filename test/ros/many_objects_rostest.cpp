// SPDX-License-Identifier: BSD-3-Clause
// track_many.launch: four objects that cross each other, each followed by its own nodelet in one manager.
#include <gtest/gtest.h>

#include "rostest_main.h"
#include "tracker_harness.h"

#include "depth_object_tracker/simulator/crossing_scene.h"

#include <nodelet/NodeletList.h>
#include <nodelet/NodeletUnload.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <set>
#include <string>

namespace depth_object_tracker {
namespace {

constexpr double kFrameS = 1.0 / 30.0;
constexpr double kStartS = 4.0;  // of the scene: from here on each is hidden by half at some time
constexpr int kFrames = 150;

struct Watched {
  explicit Watched(const std::string& object_name, const std::string& mesh)
      : name(object_name),
        mesh_file(std::string(PROJECT_SOURCE_FOLDER) + "/meshes/" + mesh + ".obj"),
        status(ros::NodeHandle(), "/tracker/" + object_name + "/status"),
        pose(ros::NodeHandle(), "/tracker/" + object_name + "/pose") {}
  std::string name, mesh_file;
  Recorder<TrackerStatus> status;
  Recorder<geometry_msgs::PoseWithCovarianceStamped> pose;
};

class ManyObjects : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    objects_ = new std::vector<std::unique_ptr<Watched>>();
    for (const auto& [name, mesh] :
         {std::pair("bracket", "bracket"), {"near_mug", "mug"}, {"far_mug", "mug"}, {"drill", "drill"}}) {
      objects_->push_back(std::make_unique<Watched>(name, mesh));
    }
  }
  static void TearDownTestSuite() { delete objects_; }

  ManyObjects()
      : images_(node_.advertise<sensor_msgs::Image>("/camera/depth/image_raw", 2)),
        infos_(node_.advertise<sensor_msgs::CameraInfo>("/camera/depth/camera_info", 2)) {
    std::vector<TriangleMesh> meshes;
    for (const auto& object : *objects_) meshes.push_back(loadMesh(object->mesh_file));
    scene_ = std::make_unique<CrossingScene>(meshes, config_);
  }

  bool isReady() {
    constexpr double kLoadingPatienceS = 300.0;  // four meshes, on a machine that may be busy
    return waitUntil(
        [&] {
          for (const auto& object : *objects_) {
            if (object->status.size() == 0) return false;
          }
          return images_.getNumSubscribers() > 0 && infos_.getNumSubscribers() > 0;
        },
        kLoadingPatienceS);
  }

  sensor_msgs::ImagePtr makeImage(const CrossingFrame& frame, const ros::Time& stamp) const {
    auto image = boost::make_shared<sensor_msgs::Image>();
    image->header.stamp = stamp;
    image->header.frame_id = "camera_depth_optical_frame";
    image->encoding = sensor_msgs::image_encodings::TYPE_16UC1;
    image->width = static_cast<std::uint32_t>(config_.camera.width);
    image->height = static_cast<std::uint32_t>(config_.camera.height);
    image->step = 2 * image->width;
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(frame.depth_mm.data());
    image->data.assign(bytes, bytes + 2 * frame.depth_mm.size());
    return image;
  }

  /// Publishes an image and waits until every tracker has told its status of it.
  bool send(const CrossingFrame& frame, const ros::Time& stamp) {
    const auto info = makeCameraInfo(config_.camera);
    info->header.stamp = stamp;
    infos_.publish(info);
    images_.publish(makeImage(frame, stamp));
    return waitUntil([&] {
      for (const auto& object : *objects_) {
        const TrackerStatusConstPtr newest = object->status.newest();
        if (!newest || newest->header.stamp != stamp) return false;
      }
      return true;
    });
  }

  /// Publishes until every tracker sees the images: one may have subscribed later than another.
  bool allSeeImages() {
    const auto all_see = [&] {
      for (const auto& object : *objects_) {
        if (object->status.newest()->frames_received == 0) return false;
      }
      return true;
    };
    const CrossingFrame frame = scene_->render(kStartS);
    for (int i = 0; i < 300 && !all_see(); ++i) {
      const ros::Time stamp(900.0 + i * kFrameS);
      const auto info = makeCameraInfo(config_.camera);
      info->header.stamp = stamp;
      infos_.publish(info);
      images_.publish(makeImage(frame, stamp));
      waitUntil(all_see, 0.5);
    }
    return all_see();
  }

  static bool initialise(const std::string& name, Pose pose) {
    pose.translation() += Eigen::Vector3d(0.003, -0.002, 0.003);
    InitializeTracker call;
    call.request.pose.header.frame_id = "camera_depth_optical_frame";
    call.request.pose.pose.pose = toPoseMessage(pose);
    return ros::service::call("/tracker/" + name + "/initialize", call) && call.response.success;
  }

  static std::vector<std::unique_ptr<Watched>>* objects_;
  CrossingSceneConfig config_;
  std::unique_ptr<CrossingScene> scene_;
  ros::NodeHandle node_;
  ros::Publisher images_, infos_;
};

std::vector<std::unique_ptr<Watched>>* ManyObjects::objects_ = nullptr;

TEST_F(ManyObjects, EachIsFollowedByItsOwnTracker) {
  Recorder<visualization_msgs::MarkerArray> markers(node_, "/tracker/marker");
  ASSERT_TRUE(isReady() && allSeeImages());
  for (std::size_t k = 0; k < objects_->size(); ++k) {
    ASSERT_TRUE(initialise((*objects_)[k]->name, scene_->truth(k, kStartS))) << (*objects_)[k]->name;
  }
  std::vector<double> largest_m(objects_->size(), 0.0), least_visible(objects_->size(), 1.0);
  double frame_time_s = 0.0;
  for (int i = 0; i < kFrames; ++i) {
    const CrossingFrame& frame = scene_->render(kStartS + i * kFrameS);
    const ros::Time stamp(1000.0 + i * kFrameS);
    ASSERT_TRUE(send(frame, stamp)) << "image " << i;
    for (std::size_t k = 0; k < objects_->size(); ++k) {
      const Watched& object = *(*objects_)[k];
      least_visible[k] = std::min(least_visible[k], frame.visible_fraction[k]);
      const TrackerStatus status = *object.status.newest();
      EXPECT_NE(static_cast<int>(status.state), static_cast<int>(TrackerStatus::LOST)) << object.name << ' ' << i;
      frame_time_s += status.frame_time_s;
      if (status.state != TrackerStatus::TRACKING || i < 5) continue;
      ASSERT_TRUE(waitUntil([&] { return object.pose.newest() && object.pose.newest()->header.stamp == stamp; }));
      const auto& p = object.pose.newest()->pose.pose.position;
      const double error_m = (Eigen::Vector3d(p.x, p.y, p.z) - frame.T_camera_object[k].translation()).norm();
      largest_m[k] = std::max(largest_m[k], error_m);
    }
  }
  for (std::size_t k = 0; k < objects_->size(); ++k) {
    std::printf("%-9s largest error of the origin %.1f mm, at least %.0f %% visible\n", (*objects_)[k]->name.c_str(),
                1e3 * largest_m[k], 100.0 * least_visible[k]);
    EXPECT_LT(largest_m[k], 0.03) << (*objects_)[k]->name;
    EXPECT_TRUE(k == 0 || least_visible[k] < 0.5);
  }
  std::printf("%.1f ms a frame and object, all four at the same time\n",
              1e3 * frame_time_s / kFrames / static_cast<double>(objects_->size()));
  std::set<std::string> drawn;
  for (const auto& message : markers.messages()) {
    for (const auto& marker : message->markers) drawn.insert(marker.ns);
  }
  EXPECT_EQ(drawn, (std::set<std::string>{"bracket", "near_mug", "far_mug", "drill"})) << "one topic for rviz";
}

TEST_F(ManyObjects, OneIsTakenOutWhileTheOthersGoOn) {
  ASSERT_TRUE(isReady());
  nodelet::NodeletUnload unload;
  unload.request.name = "/tracker/drill";
  ASSERT_TRUE(ros::service::call("/tracker_manager/unload_nodelet", unload) && unload.response.success);
  EXPECT_TRUE(waitUntil([] { return !ros::service::exists("/tracker/drill/initialize", false); }));
  nodelet::NodeletList list;
  ASSERT_TRUE(ros::service::call("/tracker_manager/list", list));
  const std::set<std::string> left(list.response.nodelets.begin(), list.response.nodelets.end());
  EXPECT_EQ(left, (std::set<std::string>{"/tracker/bracket", "/tracker/near_mug", "/tracker/far_mug"}));
  ros::WallDuration(3.0).sleep();  // the loader must not bring back what was taken out on purpose
  ASSERT_TRUE(ros::service::call("/tracker_manager/list", list));
  EXPECT_EQ(list.response.nodelets.size(), 3u);
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  return runRosTests(argc, argv, "many_objects_rostest");
}
