// SPDX-License-Identifier: BSD-3-Clause
// depth_object_tracker/Tracker: wires topics, services and parameters to the tracker's thread.
#pragma once

#include "depth_object_tracker/ros/camera_info_matcher.h"
#include "depth_object_tracker/ros/tracker_services.h"
#include "depth_object_tracker/ros/tracker_worker.h"

#include <image_transport/image_transport.h>
#include <nodelet/nodelet.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <memory>
#include <optional>

namespace depth_object_tracker {

class TrackerNodelet : public nodelet::Nodelet {
 public:
  ~TrackerNodelet() override;

 private:
  void onInit() override;
  void start();
  BuiltTracker buildFromParameters(const NodeletOptions& options);
  void applyInitFile(const std::string& init_file, TrackerSession& session);
  void subscribe(const std::string& image_topic, const std::string& info_topic, const std::string& transport);
  void subscribeCommands();
  void subscribeJoints();
  std::string findInfoTopic(const std::string& image_topic);
  void onInitialPose(const geometry_msgs::PoseWithCovarianceStampedConstPtr& message);
  void onGrasp(const GraspConstPtr& message);

  // In the order of dependence: what is below uses what is above, and goes first.
  std::unique_ptr<tf2_ros::Buffer> tf_buffer_;
  std::unique_ptr<tf2_ros::TransformListener> tf_listener_;
  std::unique_ptr<TrackerWorker> worker_;
  std::unique_ptr<TrackerServices> services_;
  std::optional<CameraInfoMatcher> matcher_;
  image_transport::Subscriber image_subscriber_;
  ros::Subscriber info_subscriber_, initial_pose_subscriber_, grasp_subscriber_, twist_subscriber_, joint_subscriber_,
      command_subscriber_;
};

}  // namespace depth_object_tracker
