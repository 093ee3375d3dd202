// SPDX-License-Identifier: BSD-3-Clause
// How far an object may have turned about an axis that the image does not show: a mug's whose handle is hidden.
#pragma once

#include "depth_object_tracker/filter/depth_likelihood.h"
#include "depth_object_tracker/tracker/angle_belief.h"
#include "depth_object_tracker/tracker/screw_axis.h"

#include <array>
#include <optional>
#include <vector>

namespace depth_object_tracker {

/// For each axis what is believed of the true angle. Between images it spreads as the process has it; an image takes
/// away the turns that it contradicts. The particles do not tell: over a flat interval, the likelihood still is rough
/// by a nat or two, and a cloud settles in one of its dents.
class FreeTurn {
 public:
  /// Between two images.
  struct Motion {
    double process_variance_rad2 = 0.0;                          ///< of a rotation about one axis
    Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< as estimated, camera axes [rad/s]
    double dt_s = 0.0;
  };

  explicit FreeTurn(const std::vector<ScrewAxis>& axes);

  /// @param stddev_rad of the angle, from now on; infinite = nothing is known of it.
  void restart(double stddev_rad);

  /// @param predicted, estimate T_camera_centre before and after the image.
  /// @param exponent gamma of the filter.
  /// @param motion since the last image.
  /// @return turn, in the centre's axes, that takes the estimate to where it should be or, where that is contradicted,
  /// to the middle of what may be; none where the image shows the angle.
  std::optional<Pose> update(DepthLikelihood& likelihood, const Pose& predicted, const Pose& estimate, double exponent,
                             const Motion& motion);

  /// Particles turn about an axis that is not shown as chance has it, and go on doing so.
  /// @param velocity m/s, rad/s, camera axes. @return with the rate about such axes that was last seen, dying down.
  Vector6d shownPart(const Vector6d& velocity, const Pose& T_camera_centre) const;

  /// An image that shows too little to say anything of the angle.
  void wait(const Pose& estimate, const Motion& motion);

  /// The estimate was turned to what looks alike and fits better, by a motion in the centre's axes: a finger makes a
  /// fine handle where the mug's own is hidden.
  void turned(const Pose& T_before_now);

  /// @return the covariance of the centre's pose, no narrower about the axes than their angles are.
  Matrix6d widened(const Matrix6d& covariance, const Pose& T_camera_centre) const;

  /// The last image allows other angles about some axis.
  bool isFree() const;
  /// Of the axis that the least is known about; 0 without axes.
  double stddevRad() const;

 private:
  struct Axis {
    ScrewAxis axis;
    AngleBelief belief;
    double rate = 0.0;     // [rad/s], when it was last shown
    double doubted = 0.0;  // [rad^2], what it may be besides if the last turn was wrong
    bool is_free = false;  // the last image allows other angles
  };
  void prepare(DepthLikelihood& likelihood, const Pose& estimate);
  struct Look {
    int allowed = 0;               ///< steps that it can be turned by, either way, until the image contradicts
    bool is_contradicted = false;  ///< the estimate itself: another angle that is believed has much more for it
  };
  /// What an image says of the angle.
  Look look(DepthLikelihood& likelihood, const Pose& estimate, double exponent, Axis& axis);
  /// @param best evidence [nat]; what has much less is contradicted.
  void weigh(double best, AngleBelief& belief) const;
  /// About the estimate [rad^2].
  static double varianceOf(const Axis& axis);

  std::vector<Axis> axes_;
  std::vector<Pose> region_;                          // scratch
  std::array<double, AngleBelief::kSteps> evidence_;  // scratch: for angles from the estimate on [nat]
};

}  // namespace depth_object_tracker
