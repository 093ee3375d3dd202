// SPDX-License-Identifier: BSD-3-Clause
// The object's mesh in rviz, to be dragged to where the object is: an interactive marker that gives the initial pose.
#pragma once

#include "depth_object_tracker/ros/object_source.h"

#include <geometry_msgs/PoseStamped.h>
#include <interactive_markers/interactive_marker_server.h>
#include <interactive_markers/menu_handler.h>

#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

namespace depth_object_tracker {

/// Shown while there is no pose to track from: before the first, and when the object has been lost for a while.
class InitialPoseMarker {
 public:
  using TrackCallback = std::function<void(const geometry_msgs::PoseStamped&)>;

  /// Serves `<nodelet>/initial_pose_marker`. @param track is told the pose to start from, on a thread of its own.
  InitialPoseMarker(const std::string& nodelet, TrackCallback track);

  /// After each status, on one thread. @param camera_frame empty: no image has come yet.
  void update(const BuiltTracker& object, const TrackerResult& result, const std::string& camera_frame);

  /// Where the marker is now, from any thread; nullopt while it is not shown. Stamp zero: wherever its frame is at
  /// present.
  std::optional<geometry_msgs::PoseStamped> pose() const;

 private:
  using Clock = std::chrono::steady_clock;

  bool isWanted(TrackerState state);
  void show(const std::string& camera_frame);
  void hide();
  void place(const Pose& T_camera_object);
  visualization_msgs::InteractiveMarker makeMarker(const std::string& camera_frame) const;
  void onTrack();

  std::string cameraFrame() const;

  TrackCallback track_;
  BuiltTracker object_;
  Pose T_camera_object_;            // where the marker appears
  mutable std::mutex frame_mutex_;  // guards camera_frame_; nothing else is locked meanwhile
  std::string camera_frame_;
  std::optional<Clock::time_point> lost_since_;
  bool is_shown_ = false;
  interactive_markers::MenuHandler menu_;
  interactive_markers::InteractiveMarkerServer server_;  // last: its thread ends first
};

}  // namespace depth_object_tracker
