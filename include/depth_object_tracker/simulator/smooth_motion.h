// SPDX-License-Identifier: BSD-3-Clause
// Band-limited random motion of a rigid body with given peak speeds, kept within given bounds.
#pragma once

#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/simulator/motion_clock.h"

#include <array>
#include <cstdint>
#include <functional>

namespace depth_object_tracker {

struct SmoothMotionConfig {
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();  ///< middle of the motion
  Eigen::Matrix3d base_rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d amplitude_m = Eigen::Vector3d::Zero();
  double amplitude_rad = 0.0;     ///< about each axis
  double peak_speed_m_s = 0.0;    ///< 0: does not move
  double peak_speed_rad_s = 0.0;  ///< 0: does not turn
  double duration_s = 5.0;        ///< peaks are measured, and bounds kept, within; at most kMaxWindowS
  double first_rest_s = 0.3;
  std::uint64_t seed = 1;
};

/// Sums of sines with unrelated frequencies: smooth, endless, never repeating. Not thread-safe.
class SmoothMotion {
 public:
  static constexpr double kMaxWindowS = 600.0;

  /// @param is_allowed whether the body may be at a pose; amplitudes shrink until it may all the time (nullptr:
  /// always).
  SmoothMotion(const SmoothMotionConfig& config, const std::function<bool(const Pose&)>& is_allowed = nullptr);

  /// Pose of the moved point's frame: translation = config.centre_m + displacement.
  Pose pose(double t_s);

  double amplitudeShare() const { return amplitude_share_; }  ///< 1 = nothing had to shrink

 private:
  static constexpr int kNumSines = 4;
  struct Signal {
    std::array<double, kNumSines> amplitude, frequency_rad_s, phase;
    double at(double progress_s) const;
  };
  Eigen::Vector3d displacement(double progress_s) const;
  Eigen::Matrix3d rotation(double progress_s) const;
  double peak(double rate, bool angular);
  double rateForPeak(double wanted, bool angular);
  void chooseRates();

  SmoothMotionConfig config_;
  MotionClock clock_;
  std::array<Signal, 6> signals_;
  double amplitude_share_ = 1.0;
  double linear_rate_ = 0.0;
  double angular_rate_ = 0.0;
};

}  // namespace depth_object_tracker
