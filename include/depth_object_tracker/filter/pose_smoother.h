// SPDX-License-Identifier: BSD-3-Clause
// Estimates of one image each, averaged over as many images as the object's motion allows.
#pragma once

#include "depth_object_tracker/geometry/pose.h"

#include <array>

namespace depth_object_tracker {

/// The particle filter's process must let an object leave its rest at any moment, so its estimate of an object at rest
/// is as noisy as one image. Here the object rests, moves gently or moves lively, and how probable each is follows from
/// the estimates themselves (interacting multiple models; Blom and Bar-Shalom, IEEE TAC 33(8), 1988).
class PoseSmoother {
 public:
  /// Forgets everything: the next pose is taken as it is.
  void restart() { is_started_ = false; }

  /// @param pose of one image, of the object's centre in the camera's frame.
  /// @param covariance of its error [m^2, rad^2], camera axes, about the centre.
  /// @param dt_s [s] > 0 since the last image.
  /// @return the pose in the light of those before it; `pose` itself after a jump that no motion explains.
  Pose update(const Pose& pose, const Matrix6d& covariance, double dt_s);

  /// The camera was moved: a pose P before is T_now_before * P now.
  void moveCamera(const Pose& T_now_before);

  /// After an update [m/s, rad/s]; and the covariance of its error.
  Vector6d velocity() const;
  Matrix6d velocityCovariance() const;

  /// Of rest, after an update, in [0, 1].
  double probabilityOfRest() const { return is_started_ ? probabilities_[0] : 0.0; }

 private:
  static constexpr std::size_t kModels = 3;
  using Vector12d = Eigen::Matrix<double, 12, 1>;
  using Matrix12d = Eigen::Matrix<double, 12, 12>;
  /// Displacement from the smoothed pose and velocity; Gaussian.
  struct State {
    Vector12d mean;
    Matrix12d covariance;
  };

  void start(const Pose& pose, const Matrix6d& noise);
  void mix(double dt_s);
  void predict(double dt_s);
  /// @return false when no model explains the displacement.
  bool measure(const Vector6d& displacement, const Matrix6d& noise);
  Vector12d mean() const;

  bool is_started_ = false;
  Pose pose_ = Pose::Identity();
  std::array<State, kModels> states_;
  std::array<double, kModels> probabilities_ = {};  // rest, gentle, lively
};

}  // namespace depth_object_tracker
