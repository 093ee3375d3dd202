// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/filter/pose_statistics.h"

namespace depth_object_tracker {

PoseStatistics poseStatistics(const std::vector<Pose>& poses, const std::vector<double>& weights, const Pose& start) {
  PoseStatistics statistics;
  statistics.mean = start;
  for (int iteration = 0; iteration < 10; ++iteration) {
    Vector6d step = Vector6d::Zero();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (weights[i] > 0.0) step += weights[i] * difference(poses[i], statistics.mean);
    }
    statistics.mean = perturb(statistics.mean, step);
    if (step.norm() < 1e-12) break;
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (weights[i] <= 0.0) continue;
    const Vector6d delta = difference(poses[i], statistics.mean);
    statistics.covariance += weights[i] * delta * delta.transpose();
  }
  return statistics;
}

}  // namespace depth_object_tracker
