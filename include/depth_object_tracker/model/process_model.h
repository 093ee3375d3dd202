// SPDX-License-Identifier: BSD-3-Clause
// How a pose moves between two images: random motion of a hand-held object, or a robot's control input.
#pragma once

#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/model/control_input.h"
#include "depth_object_tracker/model/process_config.h"

#include <array>
#include <optional>

namespace depth_object_tracker {

/// One Gaussian of the displacement density: zero mean about the predicted pose, independent axes of the camera.
struct ProcessComponent {
  double weight = 1.0;
  Vector6d variances = Vector6d::Ones();  ///< [m^2, rad^2], > 0

  /// Log density [nat] of a displacement from the predicted pose, weight not included.
  double logDensity(const Vector6d& displacement) const;
};

/// The process between two images: where a particle is expected, and the density of its deviation from there: a narrow
/// Gaussian (the paper's) and, if configured, a rare wide one for sudden motion.
class ProcessStep {
 public:
  static constexpr int kMaxComponents = 2;

  /// @param dt_s >= 0; clamped to config.max_gap_s, and velocities do not survive a longer gap.
  /// @param diffusion_scale in (0, 1]: scales the standard deviations while little of the object is seen.
  /// @param slip_scale >= 1: scales those of an object in a robot's hand while it seems to move there.
  ProcessStep(const ProcessConfig& config, double dt_s, const std::optional<ControlInput>& control,
              const Eigen::Vector3d& centre_object, double diffusion_scale, double slip_scale = 1.0);

  /// The step into a first frame: no motion, but the uncertainty of an initial pose.
  /// @param variances [m^2, rad^2] of the centre's pose.
  ProcessStep(const ProcessConfig& config, const Vector6d& variances);

  /// The same without sudden motion, for an object that nothing is seen of.
  void excludeSuddenMotion();

  /// Expected pose at the end of the interval.
  /// @param velocity of the centre, [m/s, rad/s], camera axes; relative to the hand where the control is followed.
  Pose predict(const Pose& T_camera_centre, const Vector6d& velocity) const;

  /// What the control moves the centre by; zero when none is followed.
  Vector6d controlDisplacement(const Pose& T_camera_centre) const;

  /// Velocity left at the end of the interval when nothing is measured.
  Vector6d dampedVelocity(const Vector6d& velocity) const;

  int numComponents() const { return num_components_; }
  const ProcessComponent& component(int k) const { return components_[static_cast<std::size_t>(k)]; }
  const ProcessComponent& widestComponent() const { return component(num_components_ - 1); }

  /// Of the mixture [m^2, rad^2].
  Vector6d meanVariances() const;

  /// Log density [nat] of the mixture at a displacement from the predicted pose.
  double logDensity(const Vector6d& displacement) const;

  double dt() const { return dt_s_; }

 private:
  void setNoise(const ProcessConfig& config, Vector6d variances);

  double dt_s_ = 0.0;
  double control_dt_s_ = 0.0;  // not clamped: the robot's motion is known however long the gap
  std::optional<ControlInput> control_;
  Eigen::Vector3d centre_object_ = Eigen::Vector3d::Zero();
  double velocity_displacement_s_ = 0.0;  ///< integral of the damping over the interval
  double velocity_decay_ = 0.0;
  int num_components_ = 1;
  std::array<ProcessComponent, kMaxComponents> components_;
};

}  // namespace depth_object_tracker
