// SPDX-License-Identifier: BSD-3-Clause
// Mean and covariance of poses on the manifold, and Gaussians in a tangent chart.
#include "depth_object_tracker/filter/gaussian6.h"
#include "depth_object_tracker/filter/pose_statistics.h"

#include "random_pose.h"

#include <gtest/gtest.h>

namespace depth_object_tracker {
namespace {

Matrix6d randomCovariance(std::mt19937_64& engine, double scale) {
  std::normal_distribution<double> normal;
  Matrix6d factor;
  for (int i = 0; i < 36; ++i) factor(i) = normal(engine);
  return scale * scale * (factor * factor.transpose() / 6.0 + 0.1 * Matrix6d::Identity());
}

TEST(PoseStatistics, OnePoseIsItsOwnMean) {
  std::mt19937_64 engine(1);
  const Pose pose = randomPose(engine, 1.0);
  const PoseStatistics statistics = poseStatistics({pose}, {1.0}, perturb(pose, Vector6d::Constant(0.3)));
  EXPECT_LT(largestDifference(statistics.mean, pose), 1e-12);
  EXPECT_LT(statistics.covariance.norm(), 1e-20);
}

TEST(PoseStatistics, DifferencesFromTheMeanSumToZero) {
  std::mt19937_64 engine(2);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const Pose base = randomPose(engine, 1.0);
  std::vector<Pose> poses;
  std::vector<double> weights;
  for (int i = 0; i < 40; ++i) {
    Vector6d delta;
    delta << randomVector(engine, 0.5), randomVector(engine, 0.8);
    poses.push_back(perturb(base, delta));
    weights.push_back(uniform(engine));
  }
  double total = 0.0;
  for (const double weight : weights) total += weight;
  for (double& weight : weights) weight /= total;

  const PoseStatistics statistics = poseStatistics(poses, weights, poses.front());
  Vector6d sum = Vector6d::Zero();
  Matrix6d covariance = Matrix6d::Zero();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Vector6d delta = difference(poses[i], statistics.mean);
    sum += weights[i] * delta;
    covariance += weights[i] * delta * delta.transpose();
  }
  EXPECT_LT(sum.norm(), 1e-9);
  EXPECT_LT((covariance - statistics.covariance).norm(), 1e-12);
  EXPECT_TRUE(isValidPose(statistics.mean));

  const PoseStatistics from_elsewhere = poseStatistics(poses, weights, perturb(base, Vector6d::Constant(-0.2)));
  EXPECT_LT(largestDifference(statistics.mean, from_elsewhere.mean), 1e-8) << "the start must not matter";
}

TEST(PoseStatistics, OppositePerturbationsMeanTheMiddleAlsoAcrossPi) {
  std::mt19937_64 engine(3);
  for (int k = 0; k < 20; ++k) {
    const Pose middle =
        randomPose(engine, 1.0);  // any rotation: a mean of rotation vectors about the identity would fail
    Vector6d delta;
    delta << randomVector(engine, 0.3), randomVector(engine, 1.0);
    const PoseStatistics statistics =
        poseStatistics({perturb(middle, delta), perturb(middle, -delta)}, {0.5, 0.5}, perturb(middle, 0.3 * delta));
    EXPECT_LT(largestDifference(statistics.mean, middle), 1e-9);
    EXPECT_LT((statistics.covariance - delta * delta.transpose()).norm(), 1e-8);
  }
}

TEST(PoseStatistics, RecoversTheCovarianceOfSamples) {
  std::mt19937_64 engine(4);
  std::normal_distribution<double> normal;
  const Pose centre = randomPose(engine, 1.0);
  const Matrix6d covariance = randomCovariance(engine, 0.02);
  const Gaussian6 gaussian(Vector6d::Zero(), covariance);
  constexpr int kSamples = 20000;
  std::vector<Pose> poses;
  for (int i = 0; i < kSamples; ++i) {
    Vector6d standard;
    for (int axis = 0; axis < 6; ++axis) standard[axis] = normal(engine);
    poses.push_back(perturb(centre, gaussian.sample(standard)));
  }
  const PoseStatistics statistics = poseStatistics(poses, std::vector<double>(kSamples, 1.0 / kSamples), poses.front());
  const Vector6d stddev = covariance.diagonal().cwiseSqrt();
  const Vector6d error = difference(statistics.mean, centre).cwiseQuotient(stddev);
  EXPECT_LT(error.cwiseAbs().maxCoeff(), 5.0 / std::sqrt(kSamples));
  const Matrix6d relative =
      stddev.cwiseInverse().asDiagonal() * (statistics.covariance - covariance) * stddev.cwiseInverse().asDiagonal();
  EXPECT_LT(relative.cwiseAbs().maxCoeff(), 5.0 * std::sqrt(2.0 / kSamples));
}

TEST(PoseStatistics, ParticlesWithoutWeightDoNotCountWhateverTheyAre) {
  Pose broken = Pose::Identity();
  broken.matrix().setConstant(std::numeric_limits<double>::quiet_NaN());
  const PoseStatistics statistics = poseStatistics({Pose::Identity(), broken}, {1.0, 0.0}, Pose::Identity());
  EXPECT_TRUE(statistics.mean.matrix().isApprox(Pose::Identity().matrix()));
  EXPECT_TRUE(statistics.covariance.allFinite());
}

TEST(Gaussian6, DensityIsTheTextbooks) {
  std::mt19937_64 engine(5);
  const Matrix6d covariance = randomCovariance(engine, 0.1);
  Vector6d mean, x;
  mean << randomVector(engine, 1.0), randomVector(engine, 1.0);
  x << randomVector(engine, 1.0), randomVector(engine, 1.0);
  const Vector6d residual = x - mean;
  const double expected =
      -0.5 * residual.dot(covariance.inverse() * residual) - 0.5 * std::log((2.0 * M_PI * covariance).determinant());
  const Gaussian6 gaussian(mean, covariance);
  EXPECT_NEAR(gaussian.logDensity(x), expected, 1e-9 * std::abs(expected));
  EXPECT_LT((gaussian.covariance() - covariance).norm(), 1e-12);
  EXPECT_EQ(gaussian.sample(Vector6d::Zero()), mean);
}

TEST(Gaussian6, SingularCovarianceGivesFiniteSamplesAndDensities) {
  Matrix6d covariance = Matrix6d::Zero();
  covariance(2, 2) = 1e-4;
  const Gaussian6 gaussian(Vector6d::Zero(), covariance);
  EXPECT_TRUE(gaussian.sample(Vector6d::Ones()).allFinite());
  EXPECT_TRUE(std::isfinite(gaussian.logDensity(Vector6d::Zero())));
  EXPECT_NEAR(gaussian.sample(Vector6d::Unit(2)).z(), 0.01, 1e-4);
}

TEST(LogRotationVolume, IsTheDeterminantOfTheLeftJacobian) {
  std::mt19937_64 engine(6);
  for (const double size : {1e-6, 1e-4, 1e-3, 0.1, 1.0, 3.0}) {
    const Eigen::Vector3d rotation = size * randomVector(engine, 1.0).normalized();
    Eigen::Matrix3d jacobian;
    for (int axis = 0; axis < 3; ++axis) {
      // d Exp(r + h e) = Exp(J h e) Exp(r)
      const Eigen::Vector3d h = 1e-5 * Eigen::Vector3d::Unit(axis);
      jacobian.col(axis) = (logSo3(expSo3(rotation + h) * expSo3(rotation).transpose()) -
                            logSo3(expSo3(rotation - h) * expSo3(rotation).transpose())) /
                           2e-5;
    }
    EXPECT_NEAR(logRotationVolume(rotation), std::log(jacobian.determinant()), 1e-7) << "angle " << size;
  }
}

}  // namespace
}  // namespace depth_object_tracker
