// SPDX-License-Identifier: BSD-3-Clause
// The tracker's services, on threads of their own: one that waits holds up neither images nor other nodelets.
#pragma once

#include "depth_object_tracker/ros/initial_pose_marker.h"
#include "depth_object_tracker/ros/tracker_worker.h"

#include <depth_object_tracker/InitializeTracker.h>
#include <depth_object_tracker/LoadObject.h>
#include <depth_object_tracker/SetGrasp.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <ros/spinner.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <vector>

namespace depth_object_tracker {

class TrackerServices {
 public:
  /// Answers calls at once. @param worker, tf outlive this object. @param access files that ~load_object may read.
  TrackerServices(const ros::NodeHandle& private_node, TrackerWorker& worker, const tf2::BufferCore& tf,
                  FileAccess access);

  /// Told the configuration of each object that was loaded, on a service's thread.
  using LoadedCallback = std::function<void(const TrackerConfig&)>;
  void setLoadedCallback(LoadedCallback callback);

  /// Adds ~initialize_at_marker. @param marker outlives this object.
  void offerMarker(const InitialPoseMarker& marker);

  /// Ends waiting calls. The worker must still be there.
  ~TrackerServices();

 private:
  using Start = std::function<void(TrackerSession& session, InitialisationCallback callback)>;

  bool initialize(InitializeTracker::Request& request, InitializeTracker::Response& response);
  bool search(const InitializeTracker::Request& request, InitializeTracker::Response& response);
  bool loadObject(LoadObject::Request& request, LoadObject::Response& response);
  bool setGrasp(SetGrasp::Request& request, SetGrasp::Response& response);
  bool reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);

  bool initializeAtMarker(std_srvs::Trigger::Response& response);
  std::string findObstacle(const InitialPose& pose) const;
  /// Starts the tracker as `start` does and waits for TRACKING. @param timeout_s 0 = answers at once, with `accepted`.
  InitialisationOutcome startAndWait(const Start& start, double timeout_s, const std::string& accepted);
  ObjectSource sourceFor(const LoadObject::Request& request) const;

  ros::NodeHandle node_;
  TrackerWorker& worker_;
  const tf2::BufferCore& tf_;
  const FileAccess access_;
  const InitialPoseMarker* marker_ = nullptr;
  ros::CallbackQueue queue_;
  ros::AsyncSpinner spinner_;
  std::vector<ros::ServiceServer> servers_;
  std::atomic<bool> stopping_{false};
  std::mutex callback_mutex_;  // guards loaded_callback_
  LoadedCallback loaded_callback_;
};

}  // namespace depth_object_tracker
