// SPDX-License-Identifier: BSD-3-Clause
// Least squares over fiducials: exact where it can be, honest about its uncertainty, not led astray by one wrong tag.
#include "depth_object_tracker/fiducials/fiducial_pose.h"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <random>

namespace depth_object_tracker {
namespace {

Pose somePose() {
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(0.1, -0.05, 0.8);
  pose.linear() = expSo3(Eigen::Vector3d(1.0, -0.4, 2.0));
  return pose;
}

std::vector<FiducialPoint> cornersOf(int num_tags) {
  std::vector<FiducialPoint> points;
  for (int id = 0; id < num_tags; ++id) {
    Fiducial tag;
    tag.id = id;
    tag.T_object_tag.linear() = expSo3(Eigen::Vector3d(0.5 * id, 0.3, -0.2 * id));
    tag.T_object_tag.translation() = Eigen::Vector3d(0.06 * std::cos(2.0 * id), 0.06 * std::sin(2.0 * id), 0.01 * id);
    for (const Eigen::Vector3d& corner : tag.corners()) {
      FiducialPoint point;
      point.tag_id = id;
      point.p_object = corner;
      point.p_camera = somePose() * corner;
      point.covariance = Eigen::Vector3d(1e-7, 1e-7, 2e-6).asDiagonal();
      points.push_back(point);
    }
  }
  return points;
}

TEST(FiducialPose, IsExactWithoutNoise) {
  for (const int num_tags : {1, 2, 5}) {
    const auto pose = fitFiducialPose(cornersOf(num_tags));
    ASSERT_TRUE(pose);
    EXPECT_EQ(pose->num_tags, num_tags);
    EXPECT_LT(difference(pose->T_camera_object, somePose()).norm(), 1e-8);
  }
}

TEST(FiducialPose, CovarianceIsThatOfNoisyPoints) {
  std::mt19937 engine(2);
  std::normal_distribution<double> normal;
  double sum = 0.0;
  constexpr int kDraws = 500;
  for (int k = 0; k < kDraws; ++k) {
    auto points = cornersOf(3);
    for (FiducialPoint& point : points) {
      point.p_camera += point.covariance.diagonal().cwiseSqrt().cwiseProduct(
          Eigen::Vector3d(normal(engine), normal(engine), normal(engine)));
    }
    const auto pose = fitFiducialPose(points);
    ASSERT_TRUE(pose);
    const Vector6d error = difference(somePose(), pose->T_camera_object);
    sum += error.dot(pose->covariance.ldlt().solve(error)) / kDraws;
  }
  EXPECT_NEAR(sum, 6.0, 0.6);  // chi-square of 6 degrees of freedom: 0.15 is one standard deviation of the mean
}

TEST(FiducialPose, LeavesOneWrongTagOut) {
  auto points = cornersOf(4);
  for (FiducialPoint& point : points) {
    if (point.tag_id == 2) point.p_camera += Eigen::Vector3d(0.08, 0.0, 0.03);
  }
  const auto pose = fitFiducialPose(points);
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->num_tags, 3);
  EXPECT_LT(difference(pose->T_camera_object, somePose()).norm(), 1e-8);
}

TEST(FiducialPose, SaysNothingWhereItCannotKnow) {
  EXPECT_FALSE(fitFiducialPose({}));
  auto points = cornersOf(1);
  points.resize(2);
  EXPECT_FALSE(fitFiducialPose(points));
  auto line = cornersOf(1);
  for (std::size_t k = 0; k < line.size(); ++k) {
    line[k].p_object = Eigen::Vector3d(0.01 * static_cast<double>(k), 0.0, 0.0);
    line[k].p_camera = somePose() * line[k].p_object;
  }
  EXPECT_FALSE(fitFiducialPose(line));
  auto contradicting = cornersOf(2);
  for (FiducialPoint& point : contradicting) {
    if (point.tag_id == 1) point.p_camera.x() += 0.1;
  }
  EXPECT_FALSE(fitFiducialPose(contradicting));
}

}  // namespace
}  // namespace depth_object_tracker
