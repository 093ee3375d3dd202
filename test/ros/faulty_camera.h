// SPDX-License-Identifier: BSD-3-Clause
// A camera before the fault injector, and what the tracker behind it says.
#pragma once

#include "tracker_harness.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <std_msgs/String.h>

#include <cmath>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <string>

namespace depth_object_tracker {

struct InjectorReport {
  std::string fault;
  std::uint64_t received = 0, sent = 0;
};

/// The object swings slowly before the camera. Frames are sent one by one, each when the one before has gone through.
class FaultyCamera {
 public:
  static constexpr double kFrameS = 1.0 / 30.0;

  explicit FaultyCamera(const std::string& tracker)
      : tracker_(tracker),
        image_publisher_(node_.advertise<sensor_msgs::Image>("/camera/depth/image_raw", 20)),
        info_publisher_(node_.advertise<sensor_msgs::CameraInfo>("/camera/depth/camera_info", 20)),
        fault_publisher_(node_.advertise<std_msgs::String>("/fault_injector/fault", 10)),
        reports_(node_, "/fault_injector/report"),
        statuses_(node_, tracker + "/status"),
        poses_(node_, tracker + "/pose"),
        diagnostics_(node_, "/diagnostics"),
        logs_(node_, "/rosout") {}

  bool waitUntilConnected() {
    return waitUntil([&] {
      return image_publisher_.getNumSubscribers() > 0 && info_publisher_.getNumSubscribers() > 0 &&
             fault_publisher_.getNumSubscribers() > 0 && reports_.size() > 0 && statuses_.numPublishers() > 0 &&
             poses_.numPublishers() > 0 && ros::service::exists(tracker_ + "/initialize", false);
    });
  }

  /// Pose of the object in the newest frame.
  Pose truth() const {
    Pose T_camera_object = testPose();
    T_camera_object.translation().x() += 0.03 * std::sin(2.0 * M_PI * static_cast<double>(num_frames_) / 120.0);
    return T_camera_object;
  }

  InjectorReport report() const {
    InjectorReport report;
    if (const auto newest = reports_.newest())
      std::istringstream(newest->data) >> report.fault >> report.received >> report.sent;
    return report;
  }

  void setFault(const std::string& fault) {
    std_msgs::String message;
    message.data = fault;
    fault_publisher_.publish(message);
    if (fault == "time_forward") offset_ += ros::Duration(60.0);
    if (fault == "time_back") offset_ -= ros::Duration(60.0);
    EXPECT_TRUE(waitUntil([&] { return report().fault == fault; })) << fault;
  }

  /// @return the stamp that the tracker sees.
  ros::Time sendFrame(double patience_s = kPatienceS) {
    ++num_frames_;
    stamp_ += ros::Duration(kFrameS);
    const std::uint64_t received = report().received;
    const auto image = makeUint16Image(scene_.depth(truth()), testCamera().width, testCamera().height);
    const auto info = makeCameraInfo(testCamera());
    image->header.stamp = info->header.stamp = stamp_;
    info_publisher_.publish(info);
    image_publisher_.publish(image);
    // An injector that has started anew counts from 0 again.
    const bool has_arrived = waitUntil([&] { return report().received != received; }, patience_s);
    EXPECT_TRUE(has_arrived || patience_s < kPatienceS) << "the injector is gone";
    return stamp_ + offset_;
  }

  /// Sends until one frame has come out at the other end: all are connected.
  bool waitUntilThrough() {
    return waitUntil([&] {
      const ros::Time stamp = sendFrame(1.0);
      return waitUntil([&] { return status() && status()->header.stamp == stamp; }, 0.5);
    });
  }

  /// A frame that should go through whole. @return what the tracker says of it.
  TrackerStatus sendGoodFrame() {
    const ros::Time stamp = sendFrame();
    const auto answered = [&] { return status() && status()->header.stamp == stamp; };
    EXPECT_TRUE(waitUntil(answered)) << "no status for a good image";
    return status() ? *status() : TrackerStatus();
  }

  /// Moves the camera's clock without images.
  void skip(double duration_s) { stamp_ += ros::Duration(duration_s); }

  bool initialise() {
    InitializeTracker call;
    call.request.pose.header.frame_id = "camera_depth_optical_frame";
    call.request.pose.pose.pose = toPoseMessage(truth());
    return ros::service::call(tracker_ + "/initialize", call) && call.response.success;
  }

  /// Of the newest published pose, if it is of the newest frame; infinite otherwise.
  double errorM() const {
    const auto pose = poses_.newest();
    if (!pose || pose->header.stamp != stamp_ + offset_) return std::numeric_limits<double>::infinity();
    const auto& p = pose->pose.pose.position;
    return (Eigen::Vector3d(p.x, p.y, p.z) - truth().translation()).norm();
  }

  /// Frames until the pose is good again; -1 = not within `max_frames`.
  int framesUntilGood(int max_frames) {
    for (int i = 1; i <= max_frames; ++i) {
      const TrackerStatus status = sendGoodFrame();
      was_lost_ = was_lost_ || status.state == TrackerStatus::LOST;
      if (status.state != TrackerStatus::TRACKING) continue;
      waitUntil([&] { return std::isfinite(errorM()); }, 5.0);
      if (errorM() < 0.005) return i;
    }
    return -1;
  }

  /// The injector is a new process: its clock starts anew too.
  void forgetInjector() { offset_ = ros::Duration(0.0); }

  bool takeWasLost() { return std::exchange(was_lost_, false); }
  TrackerStatusConstPtr status() const { return statuses_.newest(); }
  std::size_t numStatuses() const { return statuses_.size(); }
  std::size_t numLogs() const { return logs_.size(); }

  /// What the tracker said since: in a status, a log line or /diagnostics.
  bool hasSaid(const std::string& text, std::size_t from_status, std::size_t from_log) const {
    const auto statuses = statuses_.messages();
    for (std::size_t i = from_status; i < statuses.size(); ++i) {
      if (statuses[i]->reason.find(text) != std::string::npos) return true;
    }
    const auto logs = logs_.messages();
    for (std::size_t i = from_log; i < logs.size(); ++i) {
      if (logs[i]->msg.find(text) != std::string::npos) return true;
    }
    const auto diagnostics = diagnostics_.newest();
    for (const auto& part : diagnostics ? diagnostics->status : std::vector<diagnostic_msgs::DiagnosticStatus>()) {
      if (part.message.find(text) != std::string::npos) return true;
    }
    return false;
  }

 private:
  ros::NodeHandle node_;
  std::string tracker_;
  ros::Publisher image_publisher_, info_publisher_, fault_publisher_;
  Recorder<std_msgs::String> reports_;
  Recorder<TrackerStatus> statuses_;
  Recorder<geometry_msgs::PoseWithCovarianceStamped> poses_;
  Recorder<diagnostic_msgs::DiagnosticArray> diagnostics_;
  Recorder<rosgraph_msgs::Log> logs_;
  TestScene scene_;
  ros::Time stamp_{1000.0};
  ros::Duration offset_{0.0};
  std::uint64_t num_frames_ = 0;
  bool was_lost_ = false;
};

}  // namespace depth_object_tracker
