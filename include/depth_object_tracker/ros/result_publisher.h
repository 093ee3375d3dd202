// SPDX-License-Identifier: BSD-3-Clause
// Everything that the tracker publishes; what costs something only when somebody listens.
#pragma once

#include "depth_object_tracker/ros/marker_builder.h"
#include "depth_object_tracker/ros/tracker_session.h"

#include <depth_object_tracker/TrackerStatus.h>
#include <image_transport/image_transport.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <tf2_ros/transform_broadcaster.h>

namespace depth_object_tracker {

/// After construction used by the tracker's thread alone.
class ResultPublisher {
 public:
  ResultPublisher(ros::NodeHandle private_node, const NodeletOptions& options);

  void setObject(const BuiltTracker& object);

  /// Pose, twist and tf, unless LOST or UNINITIALIZED; particles, pictures and markers for those who listen, empty ones
  /// while there is no pose: what is drawn of an older one goes away. Pose, twist, tf and particles are told in the
  /// outcome's output frame, pictures and markers in the camera's.
  void publish(const FrameOutcome& outcome, const BuiltTracker& object);

  void publishStatus(const TrackerStatus& status);

  /// Where the likelihood reads the depth, for tests of zero copy; only with ~publish_debug.
  void publishImageAddress(const std::uint8_t* data);

  /// Particles, pictures and markers made so far: tests see that nobody pays for what nobody wants.
  std::uint64_t numCostlyMessages() const { return num_costly_messages_; }

 private:
  template <typename Publisher>
  bool isWanted(const Publisher& publisher);
  void publishPose(const std_msgs::Header& header, const TrackerResult& result, const std::string& child_frame);
  void publishHand(const HandReport& hand, const std_msgs::Header& header);
  void publishParticles(const std_msgs::Header& header, const ObjectTracker& tracker, const Pose& T_target_camera);
  void publishOcclusion(const FrameOutcome& outcome, const ObjectTracker& tracker);
  void publishOverlay(const FrameOutcome& outcome, const ObjectTracker& tracker);

  bool publish_tf_;
  std::uint64_t num_costly_messages_ = 0;
  MarkerBuilder marker_builder_;
  tf2_ros::TransformBroadcaster tf_broadcaster_;
  ros::Publisher pose_, twist_, particles_, particle_poses_, particle_points_, occlusion_, camera_info_, marker_, slip_,
      kinematic_correction_, object_, status_, image_address_;
  image_transport::Publisher overlay_;  // the one picture worth compressing on its way to another machine
};

}  // namespace depth_object_tracker
