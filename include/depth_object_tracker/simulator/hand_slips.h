// SPDX-License-Identifier: BSD-3-Clause
// When and how far an object is pushed in the hand that holds it.
#pragma once

#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/simulator/random_source.h"

#include <vector>

namespace depth_object_tracker {

/// Endless series of pushes, each to a new random offset from the first grasp. Not thread-safe.
class HandSlips {
 public:
  /// @param pivot_object point [m] in the object frame about which pushes rotate
  HandSlips(std::uint64_t seed, const Eigen::Vector3d& pivot_object);

  /// Pose of the object in its own frame at the first grasp, T_grasped_object; identity until the first push.
  Pose offset(double t_s);

  /// True while a push moves the object.
  bool isSlipping(double t_s);

  /// How near the pushing hand is: 0 = away, 1 = touching (before, during and shortly after every push).
  double pusherPresence(double t_s);

 private:
  struct Slip {
    double start_s, end_s;
    Vector6d from, to;
  };
  const Slip& slipAt(double t_s);

  RandomSource random_;
  Eigen::Vector3d pivot_object_;
  std::vector<Slip> slips_;
};

}  // namespace depth_object_tracker
