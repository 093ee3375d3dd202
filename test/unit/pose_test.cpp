// SPDX-License-Identifier: BSD-3-Clause
// Group axioms, small angles, angles near pi, perturbations and covariance transport.
#include "depth_object_tracker/geometry/pose.h"

#include "random_pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace depth_object_tracker {
namespace {

TEST(Pose, SkewIsTheCrossProduct) {
  std::mt19937_64 engine(1);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d a = randomVector(engine, 2.0), b = randomVector(engine, 2.0);
    EXPECT_LT((skew(a) * b - a.cross(b)).norm(), 1e-14);
  }
}

TEST(Pose, ExpGivesRotationsAndTurnsRightHanded) {
  std::mt19937_64 engine(2);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Matrix3d R = expSo3(randomVector(engine, 4.0));
    EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_NEAR(R.determinant(), 1.0, 1e-14);
  }
  EXPECT_LT((expSo3({0.0, 0.0, M_PI / 2.0}) * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-15);
}

TEST(Pose, ExpObeysGroupAxioms) {
  std::mt19937_64 engine(3);
  EXPECT_EQ(expSo3(Eigen::Vector3d::Zero()), Eigen::Matrix3d::Identity());
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d w = randomVector(engine, 2.0);
    EXPECT_LT((expSo3(w) * expSo3(-w) - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_LT((expSo3(0.3 * w) * expSo3(0.7 * w) - expSo3(w)).norm(), 1e-14);
    // Conjugation turns the axis.
    const Eigen::Matrix3d R = randomRotation(engine);
    EXPECT_LT((R * expSo3(w) * R.transpose() - expSo3(R * w)).norm(), 1e-14);
  }
}

TEST(Pose, LogInvertsExpAtEveryMagnitude) {
  std::mt19937_64 engine(4);
  for (const double angle :
       {0.0, 1e-300, 1e-14, 1e-9, 1e-6, 0.99e-4, 1.01e-4, 1e-3, 0.5, 2.0, 3.0, M_PI - 1e-3, M_PI - 1e-6, M_PI - 1e-9}) {
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d w = angle * randomVector(engine, 1.0).normalized();
      EXPECT_LT((logSo3(expSo3(w)) - w).norm(), 1e-14 + 2e-15 * angle) << "angle " << angle;
    }
  }
}

TEST(Pose, LogOfSmallRotationsKeepsItsDigits) {
  const Eigen::Vector3d w(3e-9, -4e-9, 1e-9);
  EXPECT_LT((logSo3(expSo3(w)) - w).norm(), 1e-8 * w.norm());
}

TEST(Pose, LogOfHalfTurnsHasNormPi) {
  std::mt19937_64 engine(5);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d axis = randomVector(engine, 1.0).normalized();
    const Eigen::Vector3d w = logSo3(expSo3(M_PI * axis));
    EXPECT_NEAR(w.norm(), M_PI, 1e-14);
    EXPECT_NEAR(std::abs(w.normalized().dot(axis)), 1.0, 1e-14);
    EXPECT_LE(logSo3(expSo3((M_PI + 0.1) * axis)).norm(), M_PI);
  }
}

TEST(Pose, PerturbAddsTranslationAndTurnsFromTheLeft) {
  Pose pose = Pose::Identity();
  pose.translation() << 1.0, 2.0, 3.0;
  pose.linear() = expSo3({0.0, M_PI / 2.0, 0.0});
  Vector6d delta;
  delta << 0.1, 0.2, 0.3, 0.0, 0.0, M_PI / 2.0;
  const Pose moved = perturb(pose, delta);
  EXPECT_LT((moved.translation() - Eigen::Vector3d(1.1, 2.2, 3.3)).norm(), 1e-15);
  EXPECT_LT((moved.linear() - expSo3({0.0, 0.0, M_PI / 2.0}) * pose.linear()).norm(), 1e-15);
}

TEST(Pose, DifferenceInvertsPerturb) {
  std::mt19937_64 engine(6);
  for (int i = 0; i < 200; ++i) {
    const Pose from = randomPose(engine, 1.0), to = randomPose(engine, 1.0);
    EXPECT_LT(largestDifference(perturb(from, difference(to, from)), to), 1e-14);
    Vector6d delta;
    delta << randomVector(engine, 1.0), randomVector(engine, 1.7);
    EXPECT_LT((difference(perturb(from, delta), from) - delta).norm(), 1e-13);
  }
}

TEST(Pose, TransportCovarianceAgreesWithMovedSamples) {
  // Perturbations of a body about its centre, seen at its mesh origin: to first order exactly J.
  std::mt19937_64 engine(7);
  const Pose centre = randomPose(engine, 0.5);
  const Eigen::Vector3d centre_in_object(0.03, -0.08, 0.12);
  const Matrix6d root = Matrix6d::Random() * 1e-5;
  const Matrix6d covariance = root * root.transpose();
  std::normal_distribution<double> normal;
  Matrix6d sampled = Matrix6d::Zero();
  constexpr int kNumSamples = 200000;
  Pose T_centre_origin = Pose::Identity();
  T_centre_origin.translation() = -centre_in_object;
  const Pose origin = centre * T_centre_origin;
  for (int i = 0; i < kNumSamples; ++i) {
    Vector6d white;
    for (int k = 0; k < 6; ++k) white[k] = normal(engine);
    const Vector6d delta = difference(perturb(centre, root * white) * T_centre_origin, origin);
    sampled += delta * delta.transpose() / kNumSamples;
  }
  const Matrix6d transported = transportCovariance(covariance, -(centre.linear() * centre_in_object));
  // Entries of a sample covariance scatter by sqrt((c_ii c_jj + c_ij^2) / n): allow five times that.
  for (int row = 0; row < 6; ++row) {
    for (int col = 0; col < 6; ++col) {
      const double scatter =
          std::sqrt((transported(row, row) * transported(col, col) + std::pow(transported(row, col), 2)) / kNumSamples);
      EXPECT_NEAR(sampled(row, col), transported(row, col), 5.0 * scatter) << row << "," << col;
    }
  }
}

TEST(Pose, VariancesAreTheSameAboutAllAxes) {
  EXPECT_TRUE(poseVariances(0.1, 2.0).isApprox((Vector6d() << 0.01, 0.01, 0.01, 4.0, 4.0, 4.0).finished(), 1e-12));
}

TEST(Pose, TheAngleOfARotationIsThatOfItsVector) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1.0, -2.0, 0.5).normalized();
  for (const double angle : {0.0, 1e-9, 0.3, 2.0, M_PI - 1e-7, M_PI}) {
    EXPECT_NEAR(rotationAngle(expSo3(angle * axis)), angle, 1e-9);
    EXPECT_NEAR(rotationAngle(expSo3(-angle * axis)), angle, 1e-9);
  }
}

TEST(Pose, TransportThereAndBackIsTheIdentity) {
  const Matrix6d root = Matrix6d::Random();
  const Matrix6d covariance = root * root.transpose();
  const Eigen::Vector3d offset(0.1, -0.2, 0.3);
  EXPECT_LT((transportCovariance(transportCovariance(covariance, offset), -offset) - covariance).norm(), 1e-13);
}

TEST(Pose, ValidityRefusesNanScaleAndReflection) {
  std::mt19937_64 engine(8);
  const Pose pose = randomPose(engine, 1.0);
  EXPECT_TRUE(isValidPose(pose));
  Pose bad = pose;
  bad.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(isValidPose(bad));
  bad = pose;
  bad.translation().z() = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(isValidPose(bad));
  bad = pose;
  bad.linear() *= 1.0001;
  EXPECT_FALSE(isValidPose(bad));
  bad = pose;
  bad.linear() *= -1.0;
  EXPECT_FALSE(isValidPose(bad));
  bad = pose;
  bad.linear().setZero();
  EXPECT_FALSE(isValidPose(bad));
}

}  // namespace
}  // namespace depth_object_tracker
