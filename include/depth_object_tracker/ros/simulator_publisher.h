// SPDX-License-Identifier: BSD-3-Clause
// What the simulator says: images, ground truth, frames, the robot's commands.
#pragma once

#include "depth_object_tracker/simulator/scene_simulator.h"

#include <image_transport/camera_publisher.h>
#include <ros/node_handle.h>
#include <sensor_msgs/CameraInfo.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <string>

namespace depth_object_tracker {

constexpr const char* kWorldFrame = "world";
constexpr const char* kCameraLinkFrame = "camera_link";
constexpr const char* kStereoLeftFrame = "stereo_left_optical_frame";
constexpr const char* kCameraOpticalFrame = "camera_depth_optical_frame";

/// Advertises on construction. Publishing is for one thread.
class SimulatorPublisher {
 public:
  /// @param name_space absolute; `camera/...`, `ground_truth/...`, `control_twist` and `grasp` lie below. Given,
  /// because a nodelet
  ///   of the root namespace has a node handle whose relative names land in its manager's namespace.
  /// @param private_node for `~initial_pose`
  SimulatorPublisher(ros::NodeHandle node, ros::NodeHandle private_node, const std::string& name_space,
                     const SimulationConfig& config);

  /// The object is held by this link of a robot whose root stands at T_world_base.
  void setRobot(const std::string& root_link, const Pose& T_world_base, const std::string& hand_link);

  void publishFrames();
  /// Whether somebody looks at the grey pictures.
  bool isStereoWanted() const { return left_.getNumSubscribers() > 0 || right_.getNumSubscribers() > 0; }
  /// Latched; stamp 0 = good for any time.
  void publishInitialPose(const Pose& T_camera_object, double error_m, double error_rad);
  bool hasTracker() const { return initial_pose_.getNumSubscribers() > 0; }
  /// Latched: the robot holds the object from now on.
  void publishGrasp(const ros::Time& stamp);
  void publish(const SimulatedFrame& frame, const ros::Time& stamp);

 private:
  void publishImage(const SimulatedFrame& frame, const std_msgs::Header& header);
  void publishStereo(const SimulatedFrame& frame, const ros::Time& stamp);
  void publishTruth(const SimulatedFrame& frame, const std_msgs::Header& header);
  void publishControl(const ControlInput& control, const std_msgs::Header& header);

  SimulationConfig config_;
  std::string root_link_, hand_link_;  // empty = no robot
  Pose T_world_base_ = Pose::Identity();
  image_transport::CameraPublisher camera_, left_, right_;
  sensor_msgs::CameraInfo camera_info_;
  ros::Publisher truth_, occlusion_, initial_pose_, control_twist_, grasp_;
  tf2_ros::StaticTransformBroadcaster frames_;
};

}  // namespace depth_object_tracker
