// SPDX-License-Identifier: BSD-3-Clause
// The filter moves as the process models say and knows how well it knows.
#include "depth_object_tracker/fiducials/pose_kalman_filter.h"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <random>

namespace depth_object_tracker {
namespace {

constexpr double kDtS = 1.0 / 30.0;
const Eigen::Vector3d kCentre(0.02, 0.03, -0.05);

Matrix6d measurementNoise() {
  Vector6d variances;
  variances << Eigen::Vector3d::Constant(1e-6), Eigen::Vector3d::Constant(1e-4);
  return variances.asDiagonal();
}

Pose start() {
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(0.0, 0.1, 0.8);
  pose.linear() = expSo3(Eigen::Vector3d(0.2, 0.5, -1.0));
  return pose;
}

TEST(PoseKalmanFilter, FollowsTheRobotWithoutMeasurements) {
  PoseKalmanFilter filter(PoseKalmanConfig(), kCentre);
  filter.initialise(start(), measurementNoise());
  ControlInput control;
  control.grasped = true;
  control.linear_m_s = Eigen::Vector3d(0.1, -0.2, 0.05);
  control.angular_rad_s = Eigen::Vector3d(0.0, 1.0, 0.5);
  Pose truth = start();
  for (int k = 0; k < 60; ++k) {
    filter.predict(kDtS, control);
    Vector6d displacement;
    displacement << control.linear_m_s * kDtS, control.angular_rad_s * kDtS;
    truth = perturb(truth, displacement);
  }
  EXPECT_LT(difference(filter.pose(), truth).norm(), 1e-9);
}

TEST(PoseKalmanFilter, UncertaintyGrowsUnseenAndLessInARobotsHand) {
  Matrix6d unseen[2];
  for (const bool grasped : {false, true}) {
    PoseKalmanFilter filter(PoseKalmanConfig(), kCentre);
    filter.initialise(start(), measurementNoise());
    ControlInput control;
    control.grasped = grasped;
    Matrix6d before = filter.covariance();
    EXPECT_LT((before - measurementNoise()).norm(), 1e-12);
    for (int k = 0; k < 15; ++k) filter.predict(kDtS, control);
    EXPECT_GT(filter.covariance().trace(), 2.0 * before.trace());
    unseen[grasped ? 1 : 0] = filter.covariance();
  }
  EXPECT_GT(unseen[0](0, 0), 4.0 * unseen[1](0, 0));
}

TEST(PoseKalmanFilter, SmoothsAMovingObjectAndIsCalibrated) {
  std::mt19937 engine(3);
  std::normal_distribution<double> normal;
  PoseKalmanFilter filter(PoseKalmanConfig(), kCentre);
  filter.initialise(start(), measurementNoise());
  double squared = 0.0;
  constexpr int kFrames = 300;
  for (int k = 1; k <= kFrames; ++k) {
    const double t = k * kDtS;
    Vector6d moved;
    moved << 0.05 * std::sin(2.0 * t), 0.05 * std::sin(3.0 * t), 0.0, 0.3 * std::sin(t), 0.0, 0.0;
    const Pose truth = perturb(start(), moved);
    Vector6d noise;
    for (int i = 0; i < 6; ++i) noise[i] = normal(engine) * std::sqrt(measurementNoise()(i, i));
    filter.predict(kDtS, std::nullopt);
    ASSERT_TRUE(filter.update(perturb(truth, noise), measurementNoise())) << k;
    const Vector6d error = difference(truth, filter.pose());
    squared += error.dot(filter.covariance().ldlt().solve(error)) / kFrames;
  }
  EXPECT_GT(squared, 3.0);
  EXPECT_LT(squared, 7.5);
  EXPECT_LT((filter.covariance() - filter.covariance().transpose()).norm(), 1e-12);
}

TEST(PoseKalmanFilter, RefusesWhatIsImpossiblyFar) {
  PoseKalmanFilter filter(PoseKalmanConfig(), kCentre);
  filter.initialise(start(), measurementNoise());
  filter.predict(kDtS, std::nullopt);
  const Pose before = filter.pose();
  Vector6d far = Vector6d::Zero();
  far[0] = 1.0;
  EXPECT_FALSE(filter.update(perturb(start(), far), measurementNoise()));
  EXPECT_TRUE(filter.pose().isApprox(before));
}

}  // namespace
}  // namespace depth_object_tracker
