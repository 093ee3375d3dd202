// SPDX-License-Identifier: BSD-3-Clause
// How a held object moves in the hand, from what the depth images and the robot's joints say of each step.
#pragma once

#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/model/slip_config.h"

#include <array>

namespace depth_object_tracker {

/// What two images and the motion of the hand between them say about one step.
struct HandStep {
  Vector6d residual = Vector6d::Zero();  ///< from where the hand would have taken the object to where it is [m, rad]
  Vector6d pose_variances = Vector6d::Ones();  ///< of the pose at the end of the step [m^2, rad^2]
  Vector6d hand_velocity = Vector6d::Zero();   ///< of the held object as the robot has it [m/s, rad/s]
  Eigen::Matrix3d R_camera_object = Eigen::Matrix3d::Identity();  ///< the first three are in camera axes
  double dt_s = 0.0;                                              ///< > 0
};

struct SlipEstimate {
  Vector6d relative_twist = Vector6d::Zero();  ///< of the object in the hand [m/s, rad/s], camera axes
  Matrix6d covariance = Matrix6d::Identity();  ///< of it, errors of the kinematics included
  /// Squared Mahalanobis length of the twist, were somebody pushing the arm: below 2 at most times, 4 to 50 in a slip.
  double statistic = 0.0;
  bool slipping = false;
};

/// Six independent Kalman filters along the object's axes, each of position in the hand and velocity (an
/// Ornstein-Uhlenbeck process). The residuals' sum is a position: errors of the poses do not add up in it, so that slow
/// slips are seen as well. Whatever contradicts the joints widens the noise; a slip is what an arm that is pushed or
/// bends cannot do: it turns by little while it moves the hand, about joints far away. Not thread-safe.
class SlipEstimator {
 public:
  explicit SlipEstimator(const SlipConfig& config) : config_(config) {}

  /// A new grasp.
  void reset();

  /// @return the estimate in the camera axes of the end of the step.
  SlipEstimate update(const HandStep& step);

  /// How much wider than usual the object's noise in the hand is to be, from the last estimate: >= 1.
  double noiseScale() const;

 private:
  struct Axis {
    double measured = 0.0;  // sum of the residuals
    double position = 0.0, velocity = 0.0;
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  };
  void advance(Axis& axis, double dt_s, double stationary_stddev) const;
  static void correct(Axis& axis, double variance);

  SlipConfig config_;
  bool started_ = false;
  std::array<Axis, 6> axes_;
  double contradiction_ = 0.0;  // statistic, were nobody pushing
  bool slipping_ = false;
};

}  // namespace depth_object_tracker
