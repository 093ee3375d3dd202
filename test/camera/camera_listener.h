// SPDX-License-Identifier: BSD-3-Clause
// What a camera and a tracker publish about the virtual scene, compared with the truth that its images carry.
#pragma once

#include "recorded_camera.h"
#include "tracker_harness.h"

#include <algorithm>
#include <map>

namespace depth_object_tracker {

class CameraListener {
 public:
  CameraListener()
      : images_(node_, "/camera/depth/image_raw"),
        infos_(node_, "/camera/depth/camera_info"),
        poses_(node_, "/tracker/pose"),
        statuses_(node_, "/tracker/status"),
        logs_(node_, "/rosout"),
        initial_pose_(node_.advertise<geometry_msgs::PoseWithCovarianceStamped>("/tracker/initial_pose", 1)) {}

  const Recorder<sensor_msgs::Image>& images() const { return images_; }
  const Recorder<sensor_msgs::CameraInfo>& infos() const { return infos_; }
  const Recorder<geometry_msgs::PoseWithCovarianceStamped>& poses() const { return poses_; }
  TrackerStatusConstPtr status() const { return statuses_.newest(); }

  static const std::uint16_t* pixels(const sensor_msgs::Image& image) {
    return reinterpret_cast<const std::uint16_t*>(image.data.data());
  }

  bool waitForNewImages(std::size_t count, std::uint32_t width) const {
    const std::size_t before = images_.size();
    return waitUntil([&] { return images_.size() >= before + count && images_.newest()->width == width; });
  }

  /// The log of the manager and of this process at least.
  bool hearsLogs() const { return countLogs("") > 0 && logs_.numPublishers() >= 2; }

  bool waitForTracker() const {
    return waitUntil([&] { return statuses_.size() > 0 && initial_pose_.getNumSubscribers() > 0; });
  }

  void initialise(const Pose& T_camera_object) const {
    geometry_msgs::PoseWithCovarianceStamped pose;
    pose.header.frame_id = "camera_depth_optical_frame";
    pose.pose = toPoseMessage(T_camera_object, Matrix6d::Zero());
    initial_pose_.publish(pose);
  }

  /// Starts the tracker where the object is now and expects it to follow.
  void expectTracking() const {
    ASSERT_TRUE(waitForTracker());
    ASSERT_TRUE(waitUntil([&] { return images_.size() > 0; }));
    initialise(virtualPose(virtualTime(pixels(*images_.newest()))));
    const ros::Time begin = images_.newest()->header.stamp + ros::Duration(0.5 * kSlowness);
    ASSERT_TRUE(waitUntil([&] { return errorsSince(begin).size() >= 40; })) << reason();
    expectSmall(errorsSince(begin));
    EXPECT_EQ(static_cast<int>(status()->state), static_cast<int>(TrackerStatus::TRACKING)) << reason();
  }

  static void expectSmall(std::vector<double> errors_m) {
    std::sort(errors_m.begin(), errors_m.end());
    EXPECT_LT(errors_m[errors_m.size() / 2], 0.002);
    EXPECT_LT(errors_m.back(), 0.01);
  }

  /// Distance [m] of every pose that has the stamp of an image from the truth in that image.
  std::vector<double> errorsSince(const ros::Time& begin) const {
    std::map<ros::Time, std::uint64_t> times;
    for (const auto& image : images_.messages()) times[image->header.stamp] = virtualTime(pixels(*image));
    std::vector<double> errors_m;
    for (const auto& pose : poses_.messages()) {
      const auto time = times.find(pose->header.stamp);
      if (time == times.end() || pose->header.stamp < begin) continue;
      const auto& p = pose->pose.pose.position;
      errors_m.push_back((Eigen::Vector3d(p.x, p.y, p.z) - virtualPose(time->second).translation()).norm());
    }
    return errors_m;
  }

  int countLogs(const std::string& part) const {
    int count = 0;
    for (const auto& log : logs_.messages()) count += log->msg.find(part) != std::string::npos ? 1 : 0;
    return count;
  }
  bool waitForLog(const std::string& part, int count = 1) const {
    return waitUntil([&] { return countLogs(part) >= count; });
  }

 private:
  std::string reason() const { return status() ? status()->reason : "no status"; }

  ros::NodeHandle node_;
  Recorder<sensor_msgs::Image> images_;
  Recorder<sensor_msgs::CameraInfo> infos_;
  Recorder<geometry_msgs::PoseWithCovarianceStamped> poses_;
  Recorder<TrackerStatus> statuses_;
  Recorder<rosgraph_msgs::Log> logs_;
  ros::Publisher initial_pose_;
};

}  // namespace depth_object_tracker
