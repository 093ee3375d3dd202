// SPDX-License-Identifier: BSD-3-Clause
// Where to look for the object when its pose is not well known: at the start, while it is hidden, after a loss.
#pragma once

#include "depth_object_tracker/filter/random.h"
#include "depth_object_tracker/geometry/pose.h"

#include <cstdint>
#include <vector>

namespace depth_object_tracker {

class PoseSearch {
 public:
  explicit PoseSearch(std::uint64_t seed) : random_(seed) {}

  /// Poses drawn from N(mean, variances), the mean itself among them. @param[out] poses reuses its memory.
  void around(const Pose& T_camera_centre, const Vector6d& variances, int count, std::vector<Pose>& poses);

 private:
  CounterRandom random_;
  std::uint64_t call_ = 0;
};

/// How far the object may have gone from where it was last seen [m^2, rad^2].
/// @param hidden_s seconds since it was last seen, >= 0.
Vector6d searchVariances(double hidden_s);

/// How far the object has gone since it was last seen, as far as can be told: in some direction, at about the speed
/// that it had, for a while. Narrower than searchVariances(), which are to reach whatever may have happened.
/// @param velocity when it was last seen [m/s, rad/s]. @param hidden_s as above. @return [m^2, rad^2], of each axis.
Vector6d hiddenVariances(const Vector6d& velocity, double hidden_s);

}  // namespace depth_object_tracker
