// SPDX-License-Identifier: BSD-3-Clause
// Whether one image tells two poses of an object apart.
#pragma once

#include "depth_object_tracker/filter/depth_likelihood.h"
#include "depth_object_tracker/tracker/tracker_config.h"

namespace depth_object_tracker {

class ImageEvidence {
 public:
  ImageEvidence(const TriangleMesh& mesh, const TrackerConfig& config);

  /// What speaks for one pose and against the other [nat], tempered as in the filter, nothing of the past known.
  /// @param depth every second pixel is looked at.
  double between(const DepthImageView& depth, const PinholeCamera& camera, const Pose& T_camera_object,
                 const Pose& T_camera_object_other);

 private:
  Eigen::Vector3d centre_object_;
  FilterConfig filter_;
  DepthLikelihood likelihood_;
};

}  // namespace depth_object_tracker
