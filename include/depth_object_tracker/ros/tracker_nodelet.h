// SPDX-License-Identifier: BSD-3-Clause
// depth_object_tracker/Tracker: wires topics, services and parameters to the tracker's thread.
#pragma once

#include "depth_object_tracker/ros/camera_info_matcher.h"
#include "depth_object_tracker/ros/initial_pose_marker.h"
#include "depth_object_tracker/ros/live_reconfigure.h"
#include "depth_object_tracker/ros/pose_memory.h"
#include "depth_object_tracker/ros/tracker_diagnostics.h"
#include "depth_object_tracker/ros/tracker_services.h"
#include "depth_object_tracker/ros/tracker_worker.h"
#include "depth_object_tracker/ros/transform_feed.h"

#include <geometry_msgs/PoseStamped.h>
#include <image_transport/image_transport.h>
#include <nodelet/nodelet.h>

#include <memory>
#include <mutex>
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
  void offerLiveParameters(const TrackerConfig& config);
  void observe(const DiagnosticSnapshot& snapshot, const TrackerSession& session);
  bool recallLastPose(const std::string& file, const std::string& object_name, TrackerSession& session);
  void savePose();
  void startAt(const geometry_msgs::PoseWithCovarianceStamped& message, const std::string& source);
  void onDetectedPose(const geometry_msgs::PoseStampedConstPtr& message);
  void onInitialPose(const geometry_msgs::PoseWithCovarianceStampedConstPtr& message);
  void onGrasp(const GraspConstPtr& message);

  // In the order of dependence: what is below uses what is above, and goes first.
  std::unique_ptr<TransformFeed> tf_;
  std::unique_ptr<TrackerDiagnostics> diagnostics_;  // null when they are switched off
  std::unique_ptr<InitialPoseMarker> marker_;        // null when it is switched off
  std::unique_ptr<PoseMemory> pose_memory_;          // null when it is switched off
  ros::WallTimer save_timer_;
  std::unique_ptr<TrackerWorker> worker_;
  std::mutex live_mutex_;  // guards the creation of live_
  std::unique_ptr<LiveReconfigure> live_;
  std::unique_ptr<TrackerServices> services_;
  std::optional<CameraInfoMatcher> matcher_;
  bool frame_note_told_ = false, topics_told_ = false;
  image_transport::Subscriber image_subscriber_;
  ros::Subscriber info_subscriber_, initial_pose_subscriber_, detected_pose_subscriber_, grasp_subscriber_,
      twist_subscriber_, joint_subscriber_, command_subscriber_;
};

}  // namespace depth_object_tracker
