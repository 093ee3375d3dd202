// SPDX-License-Identifier: BSD-3-Clause
// Recent expected twists of a held object, and their mean over the interval between two images.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <deque>
#include <optional>

namespace depth_object_tracker {

/// Twist of the mesh origin, optical-frame axes. It describes the motion up to `stamp_s`, since the sample before.
struct TwistSample {
  double stamp_s = 0.0;
  Eigen::Vector3d linear_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_rad_s = Eigen::Vector3d::Zero();
};

/// Ordered by stamp, bounded. Not thread-safe.
class TwistBuffer {
 public:
  static constexpr std::size_t kCapacity = 2048;
  static constexpr double kHistoryS = 2.0;  ///< older samples than this, seen from the newest, are forgotten

  /// @param max_age_s a sample says nothing about times further away than this, in either direction.
  explicit TwistBuffer(double max_age_s = 0.1) : max_age_s_(max_age_s) {}

  /// Samples may come a little late; one with the stamp of another replaces it. One from before the history means that
  /// time jumped back (a bag that loops): the buffer starts anew.
  /// @return false when a number is not finite; the sample is then ignored.
  bool add(const TwistSample& sample);

  /// Time-weighted mean over (from_s, to_s]. nullopt when the samples cover less than half of it.
  /// @param from_s not before to_s: the sample that covers to_s alone.
  std::optional<TwistSample> mean(double from_s, double to_s) const;

  std::optional<double> newestStamp() const;
  void clear() { samples_.clear(); }

 private:
  double max_age_s_;
  std::deque<TwistSample> samples_;
};

}  // namespace depth_object_tracker
