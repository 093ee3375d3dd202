// SPDX-License-Identifier: BSD-3-Clause
// Particles and occlusion map as ROS messages.
#pragma once

#include "depth_object_tracker/tracker/tracker_result.h"

#include <depth_object_tracker/ParticleCloud.h>
#include <geometry_msgs/PoseArray.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/Header.h>

namespace depth_object_tracker {

ParticleCloudPtr toParticleCloud(const ParticlePoses& particles, const std_msgs::Header& header);
geometry_msgs::PoseArrayPtr toPoseArray(const ParticlePoses& particles, const std_msgs::Header& header);

/// Fields x, y, z and intensity (the weight), 32-bit floats.
sensor_msgs::PointCloud2Ptr toPointCloud(const ParticlePoses& particles, const std_msgs::Header& header);

/// 32FC1 at working resolution.
sensor_msgs::ImagePtr toOcclusionImage(const OcclusionMap& map, const std_msgs::Header& header);

/// Camera of a sampled image, as its own full resolution.
sensor_msgs::CameraInfoPtr toCameraInfo(const PinholeCamera& camera, const std_msgs::Header& header);

}  // namespace depth_object_tracker
