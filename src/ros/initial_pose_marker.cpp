// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/initial_pose_marker.h"

#include "depth_object_tracker/ros/marker_builder.h"
#include "depth_object_tracker/ros/message_conversions.h"

#include <Eigen/Geometry>

#include <utility>

namespace depth_object_tracker {
namespace {

constexpr const char* kMarkerName = "object";
constexpr double kStartDistanceM = 0.7;          // within reach of every depth camera
constexpr std::chrono::seconds kLostForGood{2};  // a short loss mends itself
constexpr float kScalePerDiameter = 1.1f;

Pose startPose() {
  Pose T_camera_object = Pose::Identity();
  T_camera_object.translation().z() = kStartDistanceM;
  return T_camera_object;
}

/// Arrows and rings along one axis of the object.
void addAxis(const Eigen::Vector3d& axis, visualization_msgs::InteractiveMarker& marker) {
  visualization_msgs::InteractiveMarkerControl control;
  const Eigen::Quaterniond rotation = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), axis);
  control.orientation.w = rotation.w();
  control.orientation.x = rotation.x();
  control.orientation.y = rotation.y();
  control.orientation.z = rotation.z();
  control.interaction_mode = visualization_msgs::InteractiveMarkerControl::MOVE_AXIS;
  marker.controls.push_back(control);
  control.interaction_mode = visualization_msgs::InteractiveMarkerControl::ROTATE_AXIS;
  marker.controls.push_back(control);
}

/// The mesh itself: dragged in the plane of the view, with a menu on the right button.
void addMesh(const BuiltTracker& object, visualization_msgs::InteractiveMarker& marker) {
  MarkerBuilder builder(false);
  builder.setObject(object);
  visualization_msgs::InteractiveMarkerControl control;
  control.always_visible = true;
  control.interaction_mode = visualization_msgs::InteractiveMarkerControl::MOVE_PLANE;
  control.orientation_mode = visualization_msgs::InteractiveMarkerControl::VIEW_FACING;
  control.independent_marker_orientation = true;
  control.orientation.w = 1.0;
  control.markers.push_back(builder.ghost(0.6f, 0.85f, 1.0f, 0.8f));
  marker.controls.push_back(control);
}

}  // namespace

InitialPoseMarker::InitialPoseMarker(const std::string& nodelet, TrackCallback track)
    : track_(std::move(track)),
      T_camera_object_(startPose()),
      server_(ros::names::append(nodelet, "initial_pose_marker"), "", true) {
  const auto track_here = [this](const visualization_msgs::InteractiveMarkerFeedbackConstPtr&) { onTrack(); };
  const auto to_start = [this](const visualization_msgs::InteractiveMarkerFeedbackConstPtr&) { place(startPose()); };
  menu_.insert("Track here", track_here);
  menu_.insert("Move in front of the camera", to_start);
}

void InitialPoseMarker::update(const BuiltTracker& object, const TrackerResult& result,
                               const std::string& camera_frame) {
  if (object.tracker != object_.tracker) {
    hide();
    object_ = object;
    T_camera_object_ = startPose();
  }
  if (result.state == TrackerState::kTracking) T_camera_object_ = result.T_camera_object;
  if (!object_.tracker || camera_frame.empty() || result.state == TrackerState::kInitializing) return;
  if (isWanted(result.state) && !is_shown_) show(camera_frame);
  if (!isWanted(result.state) && is_shown_) hide();
}

bool InitialPoseMarker::isWanted(TrackerState state) {
  if (state != TrackerState::kLost) lost_since_.reset();
  if (state == TrackerState::kUninitialized) return true;
  if (state != TrackerState::kLost) return false;
  if (!lost_since_) lost_since_ = Clock::now();
  return Clock::now() - *lost_since_ > kLostForGood;
}

void InitialPoseMarker::show(const std::string& camera_frame) {
  {
    const std::lock_guard<std::mutex> lock(frame_mutex_);
    camera_frame_ = camera_frame;
  }
  server_.insert(makeMarker(camera_frame));
  menu_.apply(server_, kMarkerName);
  server_.applyChanges();
  is_shown_ = true;
}

void InitialPoseMarker::hide() {
  server_.erase(kMarkerName);
  server_.applyChanges();
  is_shown_ = false;
}

visualization_msgs::InteractiveMarker InitialPoseMarker::makeMarker(const std::string& camera_frame) const {
  visualization_msgs::InteractiveMarker marker;
  marker.header.frame_id = camera_frame;
  marker.name = kMarkerName;
  marker.description = "drag me, right click";
  marker.pose = toPoseMessage(T_camera_object_);
  marker.scale = kScalePerDiameter * static_cast<float>(object_.tracker->diameterM());
  addMesh(object_, marker);
  for (const auto& axis : {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()}) {
    addAxis(axis, marker);
  }
  return marker;
}

void InitialPoseMarker::place(const Pose& T_camera_object) {
  std_msgs::Header header;
  header.frame_id = cameraFrame();
  server_.setPose(kMarkerName, toPoseMessage(T_camera_object), header);
  server_.applyChanges();
}

std::optional<geometry_msgs::PoseStamped> InitialPoseMarker::pose() const {
  visualization_msgs::InteractiveMarker marker;
  if (!server_.get(kMarkerName, marker)) return std::nullopt;
  geometry_msgs::PoseStamped pose;
  pose.header.frame_id = marker.header.frame_id;
  pose.pose = marker.pose;
  return pose;
}

std::string InitialPoseMarker::cameraFrame() const {
  const std::lock_guard<std::mutex> lock(frame_mutex_);
  return camera_frame_;
}

void InitialPoseMarker::onTrack() {
  if (const auto wished = pose()) track_(*wished);
}

}  // namespace depth_object_tracker
