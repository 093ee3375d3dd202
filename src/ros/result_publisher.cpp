// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/result_publisher.h"

#include "depth_object_tracker/ros/message_conversions.h"
#include "depth_object_tracker/ros/overlay.h"
#include "depth_object_tracker/ros/particle_messages.h"
#include "depth_object_tracker/ros/pose_messages.h"

#include <std_msgs/UInt64.h>
#include <boost/make_shared.hpp>

#include <limits>

namespace depth_object_tracker {
namespace {

bool isFinite(const TrackerResult& result) {
  return isValidPose(result.T_camera_object) && result.covariance.allFinite();
}

/// Nothing is known of any pixel: coarse, as there is nothing to see.
OcclusionMap emptyOcclusionMap(const PinholeCamera& camera) {
  constexpr int kFactor = 8;
  OcclusionMap map;
  map.grid = makeSamplingGrid(camera, kFactor);
  const auto num_pixels =
      static_cast<std::size_t>(map.grid.camera.width) * static_cast<std::size_t>(map.grid.camera.height);
  map.p_occluded.assign(num_pixels, std::numeric_limits<float>::quiet_NaN());
  return map;
}

}  // namespace

ResultPublisher::ResultPublisher(ros::NodeHandle private_node, const NodeletOptions& options)
    : publish_tf_(options.publish_tf), marker_builder_(options.marker_use_mesh_resource) {
  pose_ = private_node.advertise<geometry_msgs::PoseWithCovarianceStamped>("pose", 5);
  twist_ = private_node.advertise<geometry_msgs::TwistWithCovarianceStamped>("twist", 5);
  particles_ = private_node.advertise<ParticleCloud>("particles", 2);
  particle_poses_ = private_node.advertise<geometry_msgs::PoseArray>("particle_poses", 2);
  particle_points_ = private_node.advertise<sensor_msgs::PointCloud2>("particle_points", 2);
  occlusion_ = private_node.advertise<sensor_msgs::Image>("occlusion", 2);
  camera_info_ = private_node.advertise<sensor_msgs::CameraInfo>("camera_info", 2);
  overlay_ = image_transport::ImageTransport(private_node).advertise("overlay", 2);
  marker_ = private_node.advertise<visualization_msgs::MarkerArray>("marker", 2);
  slip_ = private_node.advertise<Slip>("slip", 5);
  kinematic_correction_ = private_node.advertise<geometry_msgs::PoseWithCovarianceStamped>("kinematic_correction", 5);
  object_ = private_node.advertise<visualization_msgs::Marker>("object", 1, true);
  status_ = private_node.advertise<TrackerStatus>("status", 5, true);
  if (options.publish_debug)
    image_address_ = private_node.advertise<std_msgs::UInt64>("debug/last_image_address", 5, true);
}

template <typename Publisher>
bool ResultPublisher::isWanted(const Publisher& publisher) {
  if (publisher.getNumSubscribers() == 0) return false;
  ++num_costly_messages_;
  return true;
}

void ResultPublisher::setObject(const BuiltTracker& object) {
  if (!object.tracker) return;
  marker_builder_.setObject(object);
  visualization_msgs::Marker marker = marker_builder_.ghost(0.8f, 0.8f, 0.8f, 0.7f);
  marker.header.frame_id = object.name;
  marker.frame_locked = true;  // goes where tf takes the object
  object_.publish(marker);
}

void ResultPublisher::publish(const FrameOutcome& outcome, const BuiltTracker& object) {
  const bool has_place = outcome.output.problem.empty();
  std_msgs::Header header = outcome.header;
  header.frame_id = outcome.output_frame;
  if (has_place && outcome.is_new_estimate && hasPoseToTell(outcome.result))
    publishPose(header, toFrame(outcome.result, outcome.output.T_target_source), object.name);
  if (outcome.is_new_estimate && outcome.hand && isFinite(outcome.result)) publishHand(*outcome.hand, outcome.header);
  if (!outcome.processed || !object.tracker) return;
  if (has_place) publishParticles(header, *object.tracker, outcome.output.T_target_source);
  publishOcclusion(outcome, *object.tracker);
  publishOverlay(outcome, *object.tracker);
  if (isWanted(marker_) && (!outcome.result.has_pose || isFinite(outcome.result))) {
    marker_.publish(marker_builder_.build(outcome.header, outcome.result));
  }
}

void ResultPublisher::publishPose(const std_msgs::Header& header, const TrackerResult& result,
                                  const std::string& child_frame) {
  pose_.publish(boost::make_shared<geometry_msgs::PoseWithCovarianceStamped>(toPoseStamped(result, header)));
  if (hasTwistToTell(result)) {
    twist_.publish(boost::make_shared<geometry_msgs::TwistWithCovarianceStamped>(toTwistStamped(result, header)));
  }
  if (!publish_tf_ || header.frame_id.empty()) return;
  tf_broadcaster_.sendTransform(toTransformStamped(result, header, child_frame));
}

void ResultPublisher::publishHand(const HandReport& hand, const std_msgs::Header& header) {
  slip_.publish(toSlipMessage(hand, header.stamp, header.frame_id));
  if (hand.link.empty()) return;
  kinematic_correction_.publish(toCorrectionMessage(hand, header.stamp));
  if (publish_tf_) tf_broadcaster_.sendTransform(toCorrectionTransform(hand, header.stamp));
}

void ResultPublisher::publishParticles(const std_msgs::Header& header, const ObjectTracker& tracker,
                                       const Pose& T_target_camera) {
  const bool cloud = isWanted(particles_), poses = isWanted(particle_poses_), points = isWanted(particle_points_);
  if (!cloud && !poses && !points) return;
  ParticlePoses particles = tracker.particles();
  for (Pose& pose : particles.T_camera_object) pose = T_target_camera * pose;
  if (cloud) particles_.publish(toParticleCloud(particles, header));
  if (poses) particle_poses_.publish(toPoseArray(particles, header));
  if (points) particle_points_.publish(toPointCloud(particles, header));
}

void ResultPublisher::publishOcclusion(const FrameOutcome& outcome, const ObjectTracker& tracker) {
  const bool image = isWanted(occlusion_), info = isWanted(camera_info_);
  if (!image && !info) return;
  OcclusionMap map = tracker.occlusionMap();
  if (map.p_occluded.empty()) map = emptyOcclusionMap(outcome.camera);
  if (image) occlusion_.publish(toOcclusionImage(map, outcome.header));
  if (info) camera_info_.publish(toCameraInfo(map.grid.camera, outcome.header));
}

void ResultPublisher::publishOverlay(const FrameOutcome& outcome, const ObjectTracker& tracker) {
  if (!isWanted(overlay_)) return;
  const bool shows_object = outcome.is_new_estimate && hasPoseToTell(outcome.result);
  const auto image =
      drawOverlay(outcome.depth, outcome.camera, shows_object ? tracker.renderEstimate() : std::vector<float>(),
                  tracker.occlusionMap());
  image->header = outcome.header;
  overlay_.publish(image);
}

void ResultPublisher::publishStatus(const TrackerStatus& status) {
  status_.publish(boost::make_shared<const TrackerStatus>(status));
}

void ResultPublisher::publishImageAddress(const std::uint8_t* data) {
  if (!image_address_ || data == nullptr) return;
  std_msgs::UInt64 message;
  message.data = reinterpret_cast<std::uintptr_t>(data);
  image_address_.publish(message);
}

}  // namespace depth_object_tracker
