// SPDX-License-Identifier: BSD-3-Clause
// Covariances of few samples, of mixtures, and as the data bear them out.
#include "depth_object_tracker/filter/mixture_moments.h"
#include "depth_object_tracker/filter/pose_statistics.h"
#include "depth_object_tracker/filter/score_scatter.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include <cmath>
#include <random>
#include <vector>

namespace depth_object_tracker {
namespace {

Vector6d normalVector(std::mt19937_64& engine) {
  std::normal_distribution<double> normal;
  Vector6d v;
  for (int i = 0; i < 6; ++i) v[i] = normal(engine);
  return v;
}

TEST(MixtureMoments, AreThoseOfTheWeightedComponentsWhateverTheWeightsScale) {
  std::mt19937_64 engine(3);
  const std::vector<double> log_weights = {-900.0, -899.0, -901.5, -898.2, -950.0};
  MixtureMoments moments;
  double total = 0.0;
  Vector6d mean = Vector6d::Zero();
  std::vector<Vector6d> means;
  for (const double log_weight : log_weights) {
    means.push_back(normalVector(engine));
    moments.add(log_weight, means.back(), 0.25 * Matrix6d::Identity());
    total += std::exp(log_weight + 900.0);
    mean += std::exp(log_weight + 900.0) * means.back();
  }
  mean /= total;
  Matrix6d covariance = 0.25 * Matrix6d::Identity();
  for (std::size_t i = 0; i < means.size(); ++i) {
    covariance += std::exp(log_weights[i] + 900.0) / total * (means[i] - mean) * (means[i] - mean).transpose();
  }
  EXPECT_LT((moments.mean() - mean).norm(), 1e-12);
  EXPECT_LT((moments.covariance() - covariance).norm(), 1e-10);
}

TEST(MixtureMoments, AreEmptyWithoutComponents) {
  EXPECT_TRUE(MixtureMoments().empty());
}

TEST(CompletedCovariance, OneSampleLeavesWhatWasExpectedAndItsOwnError) {
  PoseStatistics sample, expected;
  expected.covariance = 4.0 * Matrix6d::Identity();
  const Matrix6d completed = completedCovariance(sample, 1.0, expected);
  EXPECT_LT((completed - 2.0 * expected.covariance).norm(), 1e-12) << "spread, and the same again for the one draw";
}

TEST(CompletedCovariance, ManySamplesSpeakForThemselves) {
  PoseStatistics samples, expected;
  samples.covariance = Matrix6d::Identity();
  expected.covariance = 4.0 * Matrix6d::Identity();
  EXPECT_LT((completedCovariance(samples, 1e5, expected) - samples.covariance).norm(), 1e-3);
}

TEST(CompletedCovariance, GrowsWhereSamplesAndExpectationDisagree) {
  PoseStatistics samples, expected;
  samples.covariance = expected.covariance = 1e-6 * Matrix6d::Identity();
  expected.mean.translation().x() = 0.01;
  const Matrix6d completed = completedCovariance(samples, 5.0, expected);
  EXPECT_GT(completed(0, 0), 0.25 * 0.01 * 0.01);
  EXPECT_LT(completed(1, 1), 3e-6);
}

/// A linear measurement of six numbers in blocks; noise that pixels of a block share is not in the model.
class LinearImage {
 public:
  static constexpr int kBlocks = 40, kPixels = 16;

  LinearImage(double shared_stddev, std::mt19937_64& engine) {
    std::normal_distribution<double> normal;
    Matrix6d information = Matrix6d::Zero();
    Vector6d gradient = Vector6d::Zero();
    std::vector<Vector6d> jacobians;
    std::vector<double> noise;
    for (int b = 0; b < kBlocks; ++b) {
      const Vector6d of_block = normalVector(engine);
      const double shared = shared_stddev * normal(engine);
      for (int p = 0; p < kPixels; ++p) {
        jacobians.push_back(of_block + 0.5 * normalVector(engine));
        noise.push_back(shared + normal(engine));
        information += jacobians.back() * jacobians.back().transpose();
        gradient += noise.back() * jacobians.back();
      }
    }
    error = information.ldlt().solve(gradient);
    for (int b = 0; b < kBlocks; ++b) {
      Linearisation block;
      for (int p = b * kPixels; p < (b + 1) * kPixels; ++p) {
        const auto i = static_cast<std::size_t>(p);
        block.information += jacobians[i] * jacobians[i].transpose();
        block.gradient += (noise[i] - jacobians[i].dot(error)) * jacobians[i];
      }
      scores.add(block);
    }
  }

  ScoreScatter scores;
  Vector6d error;  ///< of the most likely value
};

/// Mean of e^T C^-1 e / 6 over many images, with and without calibration.
std::pair<double, double> meanNees(double shared_stddev, double exponent) {
  std::mt19937_64 engine(17);
  CovarianceCalibration calibration;
  const Vector6d vague = Vector6d::Constant(1e6);
  double with = 0.0, without = 0.0;
  constexpr int kImages = 400;
  for (int k = 0; k < kImages; ++k) {
    const LinearImage image(shared_stddev, engine);
    const Matrix6d tempered = (exponent * image.scores.information).inverse();
    const Matrix6d calibrated = calibration.calibrated(tempered, image.scores, exponent, vague, 1.0, 1.0 / 30.0);
    with += image.error.dot(calibrated.ldlt().solve(image.error)) / 6.0 / kImages;
    without += image.error.dot(tempered.ldlt().solve(image.error)) / 6.0 / kImages;
  }
  return {with, without};
}

TEST(CovarianceCalibration, FollowsTheNoiseThatThereIs) {
  for (const double shared : {0.5, 1.0, 3.0, 8.0}) {
    const auto [with, without] = meanNees(shared, 0.1);
    EXPECT_GT(with, 0.3) << "shared noise " << shared << ", before " << without;
    EXPECT_LT(with, 1.3) << "shared noise " << shared << ", before " << without;
  }
  EXPECT_LT(meanNees(0.5, 0.1).second, 0.5) << "the test's noise should need calibration";
  EXPECT_GT(meanNees(8.0, 0.1).second, 20.0);
}

TEST(CovarianceCalibration, LeavesDirectionsThatTheImageSaysNothingOf) {
  std::mt19937_64 engine(5);
  LinearImage image(3.0, engine);
  image.scores.information.row(5).setZero();
  image.scores.information.col(5).setZero();
  image.scores.scatter.row(5).setZero();
  image.scores.scatter.col(5).setZero();
  Matrix6d covariance = 1e-3 * Matrix6d::Identity();
  covariance(5, 5) = 0.04;
  CovarianceCalibration calibration;
  const Matrix6d calibrated =
      calibration.calibrated(covariance, image.scores, 0.1, Vector6d::Constant(0.04), 1.0, 1.0 / 30.0);
  EXPECT_NEAR(calibrated(5, 5), 0.04, 1e-6);
  EXPECT_GT(std::abs(calibrated(0, 0) / covariance(0, 0) - 1.0), 0.05);
}

TEST(CovarianceCalibration, NeedsEnoughOfTheImage) {
  ScoreScatter little;
  Linearisation block;
  block.information = Matrix6d::Identity();
  little.add(block);
  const Matrix6d covariance = 2.0 * Matrix6d::Identity();
  EXPECT_EQ(CovarianceCalibration().calibrated(covariance, little, 0.1, Vector6d::Ones(), 1.0, 0.03), covariance);
}

}  // namespace
}  // namespace depth_object_tracker
