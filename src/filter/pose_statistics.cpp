// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/filter/pose_statistics.h"

#include <algorithm>

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

Matrix6d completedCovariance(const PoseStatistics& of_samples, double effective_sample_size,
                             const PoseStatistics& expected) {
  constexpr double kExpectedCountsAs = 6.0;
  const double n = std::max(1.0, effective_sample_size);
  const Vector6d apart = difference(expected.mean, of_samples.mean);
  // An inverse Wishart prior's mean after n samples, with the mean's own error on top.
  const Matrix6d about_the_mean = expected.covariance + apart * apart.transpose();
  return (kExpectedCountsAs * about_the_mean + n * of_samples.covariance) / (kExpectedCountsAs + n - 1.0) *
         (1.0 + 1.0 / n);
}

}  // namespace depth_object_tracker
