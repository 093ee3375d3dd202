// SPDX-License-Identifier: BSD-3-Clause
// Seeded random rotations and poses for tests.
#pragma once

#include "depth_object_tracker/geometry/pose.h"

#include <random>

namespace depth_object_tracker {

inline Eigen::Vector3d randomVector(std::mt19937_64& engine, double half_width) {
  std::uniform_real_distribution<double> uniform(-half_width, half_width);
  const double x = uniform(engine), y = uniform(engine), z = uniform(engine);
  return {x, y, z};
}

/// Uniform over all rotations.
inline Eigen::Matrix3d randomRotation(std::mt19937_64& engine) {
  std::normal_distribution<double> normal;
  const double w = normal(engine), x = normal(engine), y = normal(engine), z = normal(engine);
  return Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
}

inline Pose randomPose(std::mt19937_64& engine, double half_width_m) {
  Pose pose = Pose::Identity();
  pose.linear() = randomRotation(engine);
  pose.translation() = randomVector(engine, half_width_m);
  return pose;
}

/// Largest difference between the entries of two poses' matrices.
inline double largestDifference(const Pose& a, const Pose& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

}  // namespace depth_object_tracker
