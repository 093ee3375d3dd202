// SPDX-License-Identifier: BSD-3-Clause
// A tracker nodelet, loaded through pluginlib by a nodelet loader in the test's process, and a camera that publishes to
// it.
#pragma once

#include "depth_messages.h"
#include "slowness.h"

#include <depth_object_tracker/InitializeTracker.h>
#include <depth_object_tracker/TrackerStatus.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <gtest/gtest.h>
#include <image_transport/image_transport.h>
#include <nodelet/loader.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Log.h>

#include "depth_object_tracker/ros/message_conversions.h"

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

namespace depth_object_tracker {

constexpr double kPatienceS = 60.0 * kSlowness;  // wall clock; only a hang waits that long, however loaded the machine

/// Calls `done` until it is true; false when that never happens.
inline bool waitUntil(const std::function<bool()>& done, double timeout_s = kPatienceS) {
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(timeout_s);
  while (!done()) {
    if (ros::WallTime::now() > deadline || !ros::ok()) return false;
    ros::WallDuration(0.002).sleep();
  }
  return true;
}

/// Everything that came on a topic.
template <typename Message>
class Recorder {
 public:
  using Pointer = boost::shared_ptr<const Message>;

  Recorder(ros::NodeHandle node, const std::string& topic) {
    const boost::function<void(const Pointer&)> record = [this](const Pointer& message) {
      const std::lock_guard<std::mutex> lock(mutex_);
      messages_.push_back(message);
    };
    subscriber_ = node.subscribe<Message>(topic, 1000, record);
  }
  std::vector<Pointer> messages() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return messages_;
  }
  std::size_t size() const { return messages().size(); }
  Pointer newest() const { return size() == 0 ? Pointer() : messages().back(); }
  std::uint32_t numPublishers() const { return subscriber_.getNumPublishers(); }
  bool isConnected() const { return numPublishers() > 0; }

 private:
  mutable std::mutex mutex_;
  std::vector<Pointer> messages_;
  ros::Subscriber subscriber_;
};

/// Publishes one image after the other and waits for what the tracker says about each: no timing is left to chance.
class TrackerHarness {
 public:
  /// @param name of the nodelet. Parameters below it must be set before.
  explicit TrackerHarness(const std::string& name)
      : name_(name),
        images_(node_),
        image_publisher_(images_.advertise("/camera/depth/image_raw", 10)),
        info_publisher_(node_.advertise<sensor_msgs::CameraInfo>("/camera/depth/camera_info", 10)),
        loader_(false),
        statuses_(node_, name + "/status"),
        poses_(node_, name + "/pose"),
        logs_(node_, "/rosout") {
    const nodelet::M_string remappings{{ros::names::resolve("depth/image"), "/camera/depth/image_raw"}};
    is_loaded_ = loader_.load(name, "depth_object_tracker/Tracker", remappings, {});
    is_ready_ = is_loaded_ && waitUntil([&] {
                  return image_publisher_.getNumSubscribers() > 0 && info_publisher_.getNumSubscribers() > 0 &&
                         statuses_.size() > 0 && logs_.isConnected();
                });
  }
  ~TrackerHarness() { loader_.unload(name_); }

  bool isReady() const { return is_ready_; }
  const std::string& name() const { return name_; }
  ros::Time stamp() const { return stamp_; }
  void setStamp(const ros::Time& stamp) { stamp_ = stamp; }
  TestScene& scene() { return scene_; }
  const Recorder<geometry_msgs::PoseWithCovarianceStamped>& poses() const { return poses_; }
  TrackerStatusConstPtr status() const { return statuses_.newest(); }

  sensor_msgs::ImagePtr goodImage(const Pose& T_camera_object = testPose()) {
    return makeUint16Image(scene_.depth(T_camera_object), testCamera().width, testCamera().height);
  }

  /// Publishes both and waits for the status that counts this image.
  TrackerStatus send(const sensor_msgs::ImagePtr& image, const sensor_msgs::CameraInfoPtr& info) {
    image->header.stamp = info->header.stamp = stamp_;
    ++num_sent_;
    info_publisher_.publish(info);
    image_publisher_.publish(sensor_msgs::ImageConstPtr(image));
    TrackerStatusConstPtr answer;
    const auto answered = [&] {
      answer = status();
      return answer && answer->frames_received >= num_sent_ && answer->header.stamp == stamp_;
    };
    if (!waitUntil(answered)) ADD_FAILURE() << "no status for the image at " << stamp_;
    return answer ? *answer : TrackerStatus();
  }
  TrackerStatus send(const sensor_msgs::ImagePtr& image) { return send(image, makeCameraInfo(testCamera())); }

  TrackerStatus step(const Pose& T_camera_object = testPose()) {
    stamp_ += ros::Duration(1.0 / 30.0);
    return send(goodImage(T_camera_object));
  }

  bool initialise(const Pose& T_camera_object = testPose()) {
    InitializeTracker call;
    call.request.pose.header.frame_id = "camera_depth_optical_frame";
    call.request.pose.pose.pose = toPoseMessage(T_camera_object);
    return ros::service::call(name_ + "/initialize", call) && call.response.success;
  }

  /// Good images must lead back to a small error within a second of them.
  void expectTracking(const Pose& T_camera_object = testPose()) {
    TrackerStatus status;
    for (int i = 0; i < 30; ++i) {
      status = step(T_camera_object);
      if (i >= 3 && status.state == TrackerStatus::TRACKING) break;
    }
    EXPECT_EQ(static_cast<int>(status.state), static_cast<int>(TrackerStatus::TRACKING)) << status.reason;
    EXPECT_EQ(status.reason, "");
    ASSERT_TRUE(waitUntil([&] { return poses_.newest() && poses_.newest()->header.stamp == stamp_; })) << "no pose";
    const auto& p = poses_.newest()->pose.pose.position;
    EXPECT_LT((Eigen::Vector3d(p.x, p.y, p.z) - T_camera_object.translation()).norm(), 0.003);
  }

  /// True when a log message with all these parts came, from this nodelet.
  bool hasLogged(const std::vector<std::string>& parts) const {
    for (const auto& log : logs_.messages()) {
      bool has_all = log->msg.find(name_) != std::string::npos;
      for (const auto& part : parts) has_all = has_all && log->msg.find(part) != std::string::npos;
      if (has_all) return true;
    }
    return false;
  }
  bool waitForLog(const std::vector<std::string>& parts) const {
    return waitUntil([&] { return hasLogged(parts); }, 10.0 * kSlowness);
  }

  /// Waits for a status without an image.
  bool waitForReason(const std::string& part) const {
    return waitUntil([&] { return status() && status()->reason.find(part) != std::string::npos; });
  }

 private:
  std::string name_;
  ros::NodeHandle node_;
  image_transport::ImageTransport images_;
  image_transport::Publisher image_publisher_;
  ros::Publisher info_publisher_;
  nodelet::Loader loader_;
  Recorder<TrackerStatus> statuses_;
  Recorder<geometry_msgs::PoseWithCovarianceStamped> poses_;
  Recorder<rosgraph_msgs::Log> logs_;
  TestScene scene_;
  ros::Time stamp_{1000.0};
  std::uint64_t num_sent_ = 0;
  bool is_loaded_ = false;
  bool is_ready_ = false;
};

inline void setGoodParameters(const std::string& nodelet) {
  ros::param::set(nodelet + "/mesh", testMeshFile());
  ros::param::set(nodelet + "/tracker/num_particles", 40);
}

}  // namespace depth_object_tracker
