// SPDX-License-Identifier: BSD-3-Clause
// From tags in pictures to points in space: by triangulation in a stereo pair, or by registered depth.
#pragma once

#include "depth_object_tracker/fiducials/fiducial_map.h"
#include "depth_object_tracker/fiducials/tag_detector.h"
#include "depth_object_tracker/geometry/depth_image.h"
#include "depth_object_tracker/geometry/pinhole_camera.h"

#include <vector>

namespace depth_object_tracker {

/// A rectified pair: the right camera stands `baseline_m` along the left one's x axis; both have the same intrinsics.
struct StereoCamera {
  PinholeCamera left;
  double baseline_m = 0.12;
};

/// One corner of a tag, on the object and as measured.
struct FiducialPoint {
  int tag_id = 0;
  Eigen::Vector3d p_object = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_camera = Eigen::Vector3d::Zero();        ///< of the left camera
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< [m^2], of p_camera
};

struct FiducialNoise {
  double corner_stddev_px = 0.2;       ///< of a corner's place in a picture, each axis, > 0
  double max_row_difference_px = 2.0;  ///< corners of one tag lie in the same row of both pictures up to this
  double depth_stddev_m = 0.003;       ///< of the plane through a tag's depth readings
};

/// Corners of the tags that both pictures show and the object carries. Pairs that no point in front of the cameras
/// explains are left out.
std::vector<FiducialPoint> triangulateTags(const FiducialMap& map, const std::vector<TagDetection>& left,
                                           const std::vector<TagDetection>& right, const StereoCamera& camera,
                                           const FiducialNoise& noise);

/// Corners from depth registered to the picture (same size, same camera): where their beams meet the plane through the
/// readings inside of the tag. Tags without enough readings in one plane are left out.
std::vector<FiducialPoint> locateTagsByDepth(const FiducialMap& map, const std::vector<TagDetection>& detections,
                                             const DepthImageView& depth, const PinholeCamera& camera,
                                             const FiducialNoise& noise);

}  // namespace depth_object_tracker
