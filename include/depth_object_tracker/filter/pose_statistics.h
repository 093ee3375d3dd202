// SPDX-License-Identifier: BSD-3-Clause
// Weighted mean and covariance of poses on the manifold.
#pragma once

#include "depth_object_tracker/geometry/pose.h"

#include <vector>

namespace depth_object_tracker {

struct PoseStatistics {
  Pose mean = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< of difference(pose, mean): [m, rad], fixed axes
};

/// Mean with zero weighted sum of differences (iterated in the tangent space) and the covariance about it.
/// @param poses not empty. @param weights as many, sum 1.
/// @param start a pose near the mean; fixes the chart of the first step.
PoseStatistics poseStatistics(const std::vector<Pose>& poses, const std::vector<double>& weights, const Pose& start);

/// Covariance of the error of a weighted mean of few samples: what they say by themselves is too small (a single one
/// has none), so it is completed by what was expected of them.
/// @param effective_sample_size of the samples, >= 1.
/// @param expected of the same quantity, as good as kExpectedCountsAs samples; its mean may differ.
Matrix6d completedCovariance(const PoseStatistics& of_samples, double effective_sample_size,
                             const PoseStatistics& expected);

}  // namespace depth_object_tracker
