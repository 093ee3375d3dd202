// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/pose_search.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
void PoseSearch::around(const Pose& T_camera_centre, const Vector6d& variances, int count, std::vector<Pose>& poses) {
  ++call_;
  poses.clear();
  for (int i = 0; i < count; ++i) {
    Vector6d displacement = Vector6d::Zero();
    if (i > 0) {
      const Vector6d normal = random_.normal6(RandomPurpose::kSearch, call_, static_cast<std::uint32_t>(i));
      displacement = variances.cwiseSqrt().cwiseProduct(normal);
    }
    poses.push_back(perturb(T_camera_centre, displacement));
  }
}

Vector6d searchVariances(double hidden_s) {
  const double position_stddev_m = std::min(0.03 + 0.05 * hidden_s, 0.20);
  const double rotation_stddev_rad = std::min(0.25 + 0.3 * hidden_s, 1.0);
  return poseVariances(position_stddev_m, rotation_stddev_rad);
}

Vector6d hiddenVariances(const Vector6d& velocity, double hidden_s) {
  constexpr double kSameSpeedS = 1.0, kLeastMps = 0.1, kLeastRadps = 0.4;
  const double moving_s = kSameSpeedS * -std::expm1(-hidden_s / kSameSpeedS);
  const auto variance = [&](double speed) { return speed * speed * moving_s * moving_s / 3.0; };
  Vector6d variances;
  variances.head<3>().setConstant(variance(std::hypot(velocity.head<3>().norm(), kLeastMps)));
  variances.tail<3>().setConstant(variance(std::hypot(velocity.tail<3>().norm(), kLeastRadps)));
  return variances;
}

}  // namespace depth_object_tracker
