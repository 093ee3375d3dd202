// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/pose_validation.h"

#include "depth_object_tracker/ros/message_conversions.h"

#include <gtest/gtest.h>

#include <limits>

namespace depth_object_tracker {
namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN();

geometry_msgs::PoseWithCovariance goodPose() {
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(0.1, -0.2, 0.9);
  pose.linear() = expSo3(Eigen::Vector3d(0.3, 0.2, -0.1));
  Matrix6d covariance = 1e-4 * Matrix6d::Identity();
  covariance(0, 4) = covariance(4, 0) = 5e-5;
  return toPoseMessage(pose, covariance);
}

bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(PoseValidation, PassesAGoodPoseUnchanged) {
  const CheckedPose checked = checkPose(goodPose());
  EXPECT_EQ(checked.problem, "");
  EXPECT_NEAR((checked.pose.translation() - Eigen::Vector3d(0.1, -0.2, 0.9)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((logSo3(checked.pose.linear()) - Eigen::Vector3d(0.3, 0.2, -0.1)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(checked.covariance(0, 4), 5e-5, 1e-12);
}

TEST(PoseValidation, NormalisesQuaternions) {
  auto message = goodPose();
  for (double* value : {&message.pose.orientation.x, &message.pose.orientation.y, &message.pose.orientation.z,
                        &message.pose.orientation.w}) {
    *value *= -7.0;
  }
  const CheckedPose checked = checkPose(message);
  EXPECT_EQ(checked.problem, "");
  EXPECT_NEAR((logSo3(checked.pose.linear()) - Eigen::Vector3d(0.3, 0.2, -0.1)).norm(), 0.0, 1e-9);
}

TEST(PoseValidation, RefusesQuaternionsWithoutDirection) {
  auto message = goodPose();
  message.pose.orientation = geometry_msgs::Quaternion();
  EXPECT_TRUE(mentions(checkPose(message).problem, "norm 0")) << checkPose(message).problem;
  message.pose.orientation.w = kNan;
  EXPECT_TRUE(mentions(checkPose(message).problem, "quaternion"));
  message.pose.orientation.w = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(mentions(checkPose(message).problem, "quaternion"));
}

TEST(PoseValidation, RefusesPositionsThatAreNotFinite) {
  auto message = goodPose();
  message.pose.position.z = kNan;
  EXPECT_TRUE(mentions(checkPose(message).problem, "position"));
}

TEST(PoseValidation, RefusesImpossibleCovariances) {
  auto message = goodPose();
  message.covariance[7] = -1e-4;
  EXPECT_TRUE(mentions(checkPose(message).problem, "covariance[7]"));
  message = goodPose();
  message.covariance[35] = kNan;
  EXPECT_TRUE(mentions(checkPose(message).problem, "covariance[35]"));
  message = goodPose();
  message.covariance[1] = 5e-5;
  EXPECT_TRUE(mentions(checkPose(message).problem, "symmetric"));
  message = goodPose();
  message.covariance[1] = message.covariance[6] = 5e-4;
  EXPECT_TRUE(mentions(checkPose(message).problem, "eigenvalue"));
}

TEST(PoseValidation, LeavesAZeroCovarianceToTheDefaults) {
  EXPECT_TRUE(fillMissingVariances(Matrix6d::Zero(), 0.01, 0.1).isZero(0.0));
}

TEST(PoseValidation, GivesAxesWithoutVarianceTheDefault) {
  Matrix6d covariance = Matrix6d::Zero();
  covariance(0, 0) = covariance(1, 1) = 0.25;
  covariance(5, 5) = 0.07;
  const Matrix6d filled = fillMissingVariances(covariance, 0.01, 0.1);
  EXPECT_EQ(filled(0, 0), 0.25);
  EXPECT_NEAR(filled(2, 2), 1e-4, 1e-12);
  EXPECT_NEAR(filled(3, 3), 1e-2, 1e-12);
  EXPECT_EQ(filled(5, 5), 0.07);
}

TEST(PoseValidation, TurnsCovariancesWithTheFrame) {
  Matrix6d covariance = Matrix6d::Zero();
  covariance(0, 0) = 4.0;
  covariance(5, 5) = 9.0;
  const Eigen::Matrix3d R = expSo3(Eigen::Vector3d(0.0, M_PI / 2, 0.0));  // x goes to -z, z goes to x
  const Matrix6d turned = rotated(covariance, R);
  EXPECT_NEAR(turned(2, 2), 4.0, 1e-9);
  EXPECT_NEAR(turned(3, 3), 9.0, 1e-9);
  EXPECT_NEAR(turned.trace(), 13.0, 1e-9);
}

}  // namespace
}  // namespace depth_object_tracker
