// SPDX-License-Identifier: BSD-3-Clause
// A first look at a pose: do some points of the object's surface lie on what the camera measured?
#pragma once

#include "depth_object_tracker/tracker/oriented_points.h"

#include <vector>

namespace depth_object_tracker {

class SparseFit {
 public:
  /// @param points of the object, from its centre, object axes. @param diameter_m of the object.
  SparseFit(const std::vector<OrientedPoint>& points, double diameter_m);

  /// Copies what it needs of the image.
  void setImage(const DepthImageView& depth, const PinholeCamera& camera);

  /// Share of the points that face the camera and are measured where they should be, less those that are seen through;
  /// -1 when most are outside of the image. Thread-safe.
  double match(const Pose& T_camera_centre) const;

 private:
  struct Point {
    Eigen::Vector3f point, normal;
  };
  std::vector<Point> points_;
  float tolerance_m_;
  SamplingGrid grid_;
  std::vector<float> depth_;  // of the grid, row-major; 0 = no reading
};

}  // namespace depth_object_tracker
