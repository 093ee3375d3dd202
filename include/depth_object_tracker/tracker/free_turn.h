// SPDX-License-Identifier: BSD-3-Clause
// How far an object may have turned about an axis that the image does not show: a mug's whose handle is hidden.
#pragma once

#include "depth_object_tracker/filter/depth_likelihood.h"
#include "depth_object_tracker/tracker/screw_axis.h"

#include <vector>

namespace depth_object_tracker {

/// For each axis the variance of the true angle about the estimate's. Between images it grows as the process has it; an
/// image bounds it by the turns that explain it about as well. The particles do not tell: over a flat interval, the
/// likelihood still is rough by a nat or two, and a cloud settles in one of its dents.
class FreeTurn {
 public:
  explicit FreeTurn(std::vector<ScrewAxis> axes);

  /// @param stddev_rad of the angle, from now on; infinite = nothing is known of it.
  void restart(double stddev_rad);

  /// An image about which the estimate is T_camera_centre. @param exponent gamma of the filter.
  /// @param process_variance_rad2 of a rotation about one axis since the last image.
  void update(DepthLikelihood& likelihood, const Pose& T_camera_centre, double exponent, double process_variance_rad2);

  /// @return the covariance of the centre's pose, no narrower about the axes than their angles are.
  Matrix6d widened(const Matrix6d& covariance, const Pose& T_camera_centre) const;

  /// Of the axis that the least is known about; 0 without axes.
  double stddevRad() const;

 private:
  struct Axis {
    ScrewAxis axis;
    double variance = 0.0;  // [rad^2]
    bool is_free = false;   // the last image allows other angles
  };
  /// How far the object can be turned one way, in steps, until the image contradicts.
  int stepsAllowed(DepthLikelihood& likelihood, const Pose& T_camera_centre, const ScrewAxis& axis, int way,
                   double least) const;

  std::vector<Axis> axes_;
  std::vector<Pose> region_;  // scratch
};

}  // namespace depth_object_tracker
