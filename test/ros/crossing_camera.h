// SPDX-License-Identifier: BSD-3-Clause
// Four objects that cross each other, two of the same mesh, as a camera sees them; and what their trackers say.
#pragma once

#include "tracker_harness.h"

#include "depth_object_tracker/simulator/crossing_scene.h"

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace depth_object_tracker {

inline std::string packageMesh(const std::string& name) {
  return std::string(PROJECT_SOURCE_FOLDER) + "/meshes/" + name + ".obj";
}

/// 16UC1, as the frame has it.
inline sensor_msgs::ImagePtr makeCrossingImage(const CrossingFrame& frame, const PinholeCamera& camera) {
  auto image = boost::make_shared<sensor_msgs::Image>();
  image->header.frame_id = "camera_depth_optical_frame";
  image->encoding = sensor_msgs::image_encodings::TYPE_16UC1;
  image->width = static_cast<std::uint32_t>(camera.width);
  image->height = static_cast<std::uint32_t>(camera.height);
  image->step = 2 * image->width;
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(frame.depth_mm.data());
  image->data.assign(bytes, bytes + 2 * frame.depth_mm.size());
  return image;
}

/// One of the objects of crossing_objects.yaml.
struct WatchedObject {
  explicit WatchedObject(const std::string& object_name)
      : name(object_name),
        status(ros::NodeHandle(), "/tracker/" + object_name + "/status"),
        pose(ros::NodeHandle(), "/tracker/" + object_name + "/pose") {}
  std::string name;
  Recorder<TrackerStatus> status;
  Recorder<geometry_msgs::PoseWithCovarianceStamped> pose;
};

class CrossingCamera {
 public:
  CrossingCamera()
      : images_(node_.advertise<sensor_msgs::Image>("/camera/depth/image_raw", 2)),
        infos_(node_.advertise<sensor_msgs::CameraInfo>("/camera/depth/camera_info", 2)),
        scene_({loadMesh(packageMesh("bracket")), loadMesh(packageMesh("mug")), loadMesh(packageMesh("mug")),
                loadMesh(packageMesh("drill"))},
               config_) {
    for (const char* name : {"bracket", "near_mug", "far_mug", "drill"}) {
      objects_.push_back(std::make_unique<WatchedObject>(name));
    }
  }

  CrossingScene& scene() { return scene_; }
  std::size_t numObjects() const { return objects_.size(); }
  const WatchedObject& object(std::size_t k) const { return *objects_[k]; }
  sensor_msgs::ImagePtr makeImage(const CrossingFrame& frame) const { return makeCrossingImage(frame, config_.camera); }

  void publish(const sensor_msgs::ImagePtr& image, const ros::Time& stamp) {
    const auto info = makeCameraInfo(config_.camera);
    info->header.stamp = image->header.stamp = stamp;
    infos_.publish(info);
    images_.publish(sensor_msgs::ImageConstPtr(image));
  }

  /// Every tracker is there, and this camera connected with them.
  bool isReady() const {
    constexpr double kLoadingPatienceS = 300.0;  // four meshes, on a machine that may be busy
    return waitUntil(
        [&] {
          for (const auto& object : objects_) {
            if (object->status.size() == 0) return false;
          }
          return images_.getNumSubscribers() > 0 && infos_.getNumSubscribers() > 0;
        },
        kLoadingPatienceS);
  }

  /// Publishes until every tracker sees the images: one may have subscribed later than another.
  bool allSeeImages(double scene_time_s) {
    const auto all_see = [&] {
      for (const auto& object : objects_) {
        if (object->status.newest()->frames_received == 0) return false;
      }
      return true;
    };
    const CrossingFrame& frame = scene_.render(scene_time_s);
    for (int i = 0; i < 300 && !all_see(); ++i) {
      publish(makeImage(frame), ros::Time(900.0 + i / 30.0));
      waitUntil(all_see, 0.5);
    }
    return all_see();
  }

  /// Tells each tracker where its object is, some millimetres off.
  bool initialiseAll(double scene_time_s) {
    for (std::size_t k = 0; k < objects_.size(); ++k) {
      Pose pose = scene_.truth(k, scene_time_s);
      pose.translation() += Eigen::Vector3d(0.003, -0.002, 0.003);
      InitializeTracker call;
      call.request.pose.header.frame_id = "camera_depth_optical_frame";
      call.request.pose.pose.pose = toPoseMessage(pose);
      if (!ros::service::call("/tracker/" + objects_[k]->name + "/initialize", call) || !call.response.success) {
        ADD_FAILURE() << objects_[k]->name << ": " << call.response.message;
        return false;
      }
    }
    return true;
  }

 private:
  CrossingSceneConfig config_;
  ros::NodeHandle node_;
  ros::Publisher images_, infos_;
  CrossingScene scene_;
  std::vector<std::unique_ptr<WatchedObject>> objects_;
};

}  // namespace depth_object_tracker
