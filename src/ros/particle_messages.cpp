// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/particle_messages.h"

#include "depth_object_tracker/ros/message_conversions.h"

#include <sensor_msgs/distortion_models.h>
#include <sensor_msgs/image_encodings.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <boost/make_shared.hpp>

#include <cstring>

namespace depth_object_tracker {

ParticleCloudPtr toParticleCloud(const ParticlePoses& particles, const std_msgs::Header& header) {
  auto message = boost::make_shared<ParticleCloud>();
  message->header = header;
  message->poses.reserve(particles.T_camera_object.size());
  for (const Pose& pose : particles.T_camera_object) message->poses.push_back(toPoseMessage(pose));
  message->weights = particles.weights;
  return message;
}

geometry_msgs::PoseArrayPtr toPoseArray(const ParticlePoses& particles, const std_msgs::Header& header) {
  auto message = boost::make_shared<geometry_msgs::PoseArray>();
  message->header = header;
  message->poses.reserve(particles.T_camera_object.size());
  for (const Pose& pose : particles.T_camera_object) message->poses.push_back(toPoseMessage(pose));
  return message;
}

sensor_msgs::PointCloud2Ptr toPointCloud(const ParticlePoses& particles, const std_msgs::Header& header) {
  auto message = boost::make_shared<sensor_msgs::PointCloud2>();
  message->header = header;
  message->height = 1;
  message->is_dense = true;
  sensor_msgs::PointCloud2Modifier modifier(*message);
  using Field = sensor_msgs::PointField;
  modifier.setPointCloud2Fields(4, "x", 1, Field::FLOAT32, "y", 1, Field::FLOAT32, "z", 1, Field::FLOAT32, "intensity",
                                1, Field::FLOAT32);
  modifier.resize(particles.T_camera_object.size());
  if (particles.T_camera_object.empty()) return message;  // the iterator takes the address of the first byte
  sensor_msgs::PointCloud2Iterator<float> point(*message, "x");
  for (std::size_t i = 0; i < particles.T_camera_object.size(); ++i, ++point) {
    const Eigen::Vector3f position = particles.T_camera_object[i].translation().cast<float>();
    for (int axis = 0; axis < 3; ++axis) point[axis] = position[axis];
    point[3] = i < particles.weights.size() ? particles.weights[i] : 0.0f;
  }
  return message;
}

sensor_msgs::ImagePtr toOcclusionImage(const OcclusionMap& map, const std_msgs::Header& header) {
  auto message = boost::make_shared<sensor_msgs::Image>();
  message->header = header;
  message->width = static_cast<std::uint32_t>(map.grid.camera.width);
  message->height = static_cast<std::uint32_t>(map.grid.camera.height);
  message->encoding = sensor_msgs::image_encodings::TYPE_32FC1;
  message->step = message->width * static_cast<std::uint32_t>(sizeof(float));
  message->data.resize(map.p_occluded.size() * sizeof(float));
  std::memcpy(message->data.data(), map.p_occluded.data(), message->data.size());
  return message;
}

sensor_msgs::CameraInfoPtr toCameraInfo(const PinholeCamera& camera, const std_msgs::Header& header) {
  auto message = boost::make_shared<sensor_msgs::CameraInfo>();
  message->header = header;
  message->width = static_cast<std::uint32_t>(camera.width);
  message->height = static_cast<std::uint32_t>(camera.height);
  message->distortion_model = sensor_msgs::distortion_models::PLUMB_BOB;
  message->D.assign(5, 0.0);
  message->K = {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0};
  message->R = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  message->P = {camera.fx, 0.0, camera.cx, 0.0, 0.0, camera.fy, camera.cy, 0.0, 0.0, 0.0, 1.0, 0.0};
  return message;
}

}  // namespace depth_object_tracker
