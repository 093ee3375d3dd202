// SPDX-License-Identifier: BSD-3-Clause
// Noisy poses of an object that rests, moves evenly, starts, stops, is carried by a robot or jumps.
#include "depth_object_tracker/filter/pose_smoother.h"

#include "depth_object_tracker/filter/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace depth_object_tracker {
namespace {

constexpr double kFrameS = 1.0 / 30.0;
constexpr double kNoiseM = 3e-4, kNoiseRad = 5e-3;

Matrix6d noiseCovariance() {
  Vector6d variances;
  variances << Eigen::Vector3d::Constant(kNoiseM * kNoiseM), Eigen::Vector3d::Constant(kNoiseRad * kNoiseRad);
  return variances.asDiagonal();
}

Vector6d noise(std::uint64_t image) {
  const CounterRandom random(11);
  Vector6d stddevs;
  stddevs << Eigen::Vector3d::Constant(kNoiseM), Eigen::Vector3d::Constant(kNoiseRad);
  return stddevs.cwiseProduct(random.normal6(RandomPurpose::kProposal, image, 0));
}

/// Where the object is after t seconds.
using Motion = std::function<Pose(double)>;

Pose at(double x_m, double turn_rad) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(0.4 + turn_rad, Eigen::Vector3d(0.6, 0.0, 0.8)).toRotationMatrix();
  pose.translation() = Eigen::Vector3d(0.1 + x_m, -0.05, 0.8);
  return pose;
}

/// @return what is left of the error in each image.
std::vector<Vector6d> errors(PoseSmoother& smoother, const Motion& motion, int images, double noise_scale = 1.0) {
  std::vector<Vector6d> result;
  for (int k = 0; k < images; ++k) {
    const Pose truth = motion(k * kFrameS);
    const Pose measured = perturb(truth, noise_scale * noise(static_cast<std::uint64_t>(k)));
    const Pose smoothed = smoother.update(measured, noiseCovariance(), k == 0 ? 0.0 : kFrameS);
    result.push_back(difference(smoothed, truth));
  }
  return result;
}

double rms(const std::vector<Vector6d>& errors, std::size_t first, std::size_t end, int begin, int size) {
  double sum = 0.0;
  for (std::size_t k = first; k < end; ++k) sum += errors[k].segment(begin, size).squaredNorm() / size;
  return std::sqrt(sum / static_cast<double>(end - first));
}

TEST(PoseSmootherTest, AtRestImagesAreAveraged) {
  PoseSmoother smoother;
  const std::vector<Vector6d> left = errors(
      smoother, [](double) { return at(0.0, 0.0); }, 150);
  EXPECT_LT(rms(left, 20, 150, 0, 3), 0.35 * kNoiseM);
  EXPECT_LT(rms(left, 20, 150, 3, 3), 0.35 * kNoiseRad);
  EXPECT_GT(smoother.probabilityOfRest(), 0.9);
}

TEST(PoseSmootherTest, EvenMotionIsFollowedWithoutDelay) {
  constexpr double kSpeedM = 1.0, kSpeedRad = 3.8;
  PoseSmoother smoother;
  const std::vector<Vector6d> left = errors(
      smoother, [](double t) { return at(kSpeedM * t, kSpeedRad * t); }, 100, 0.0);
  for (std::size_t k = 10; k < left.size(); ++k) {
    EXPECT_LT(left[k].head<3>().norm(), 0.02 * kSpeedM * kFrameS) << k;
    EXPECT_LT(left[k].tail<3>().norm(), 0.02 * kSpeedRad * kFrameS) << k;
  }
  EXPECT_LT(smoother.probabilityOfRest(), 0.01);
  EXPECT_NEAR(smoother.velocity()[0], kSpeedM, 0.02 * kSpeedM);
  EXPECT_NEAR(smoother.velocity().tail<3>().norm(), kSpeedRad, 0.02 * kSpeedRad);
}

TEST(PoseSmootherTest, SlowMotionIsNotTakenForRest) {
  constexpr double kSpeedM = 0.005;  // 0.17 mm an image: half its noise
  PoseSmoother smoother;
  const std::vector<Vector6d> left = errors(
      smoother, [](double t) { return at(kSpeedM * t, 0.0); }, 200);
  EXPECT_LT(rms(left, 20, 200, 0, 3), kNoiseM);
}

TEST(PoseSmootherTest, VelocitiesAreAsUncertainAsTheyAreSaidToBe) {
  constexpr double kSpeedM = 0.1;
  constexpr int kImages = 300, kSettling = 10;
  PoseSmoother smoother;
  double squared = 0.0;
  for (int k = 0; k < kImages; ++k) {
    const double t = k * kFrameS;
    const Pose measured = perturb(at(kSpeedM * std::sin(t), 0.0), noise(static_cast<std::uint64_t>(k)));
    smoother.update(measured, noiseCovariance(), k == 0 ? 0.0 : kFrameS);
    if (k < kSettling) continue;
    const Vector6d off = smoother.velocity() - kSpeedM * std::cos(t) * Vector6d::Unit(0);
    squared += off.dot(smoother.velocityCovariance().llt().solve(off)) / 6.0;
  }
  const double mean = squared / (kImages - kSettling);
  EXPECT_LT(mean, 2.0);
  EXPECT_GT(mean, 0.05);
}

TEST(PoseSmootherTest, StartAndStopNeitherLagNorOvershoot) {
  static constexpr double kStartS = 2.0, kStopS = 3.0, kSpeedM = 0.5;
  PoseSmoother smoother;
  const Motion motion = [](double t) { return at(kSpeedM * (std::min(std::max(t, kStartS), kStopS) - kStartS), 0.0); };
  const std::vector<Vector6d> left = errors(smoother, motion, 150);
  double most = 0.0;
  for (const Vector6d& error : left) most = std::max(most, error.head<3>().norm());
  EXPECT_LT(most, 5.0 * kNoiseM) << "in the image in which the velocity leaps by half a metre a second";
  EXPECT_LT(rms(left, 95, 150, 0, 3), 0.6 * kNoiseM) << "soon after the stop";
}

TEST(PoseSmootherTest, AJumpIsTakenAsItIs) {
  PoseSmoother smoother;
  errors(
      smoother, [](double) { return at(0.0, 0.0); }, 60);
  const Pose elsewhere = at(0.1, 1.0);
  const Pose told = smoother.update(elsewhere, noiseCovariance(), kFrameS);
  EXPECT_EQ(told.matrix(), elsewhere.matrix());
}

TEST(PoseSmootherTest, AfterAGapTheNextPoseIsTakenAsItIs) {
  PoseSmoother smoother;
  errors(
      smoother, [](double) { return at(0.0, 0.0); }, 60);
  const Pose aside = at(5e-4, 0.0);
  EXPECT_EQ(smoother.update(aside, noiseCovariance(), 2.0).matrix(), aside.matrix());
  smoother.restart();
  EXPECT_EQ(smoother.update(at(0.0, 0.0), noiseCovariance(), kFrameS).matrix(), at(0.0, 0.0).matrix());
}

TEST(PoseSmootherTest, TheCamerasPlaceMakesNoDifference) {
  const Pose T_other_camera = at(-0.3, 2.0);
  PoseSmoother here, there;
  for (int k = 0; k < 60; ++k) {
    const Pose measured = perturb(at(0.002 * k, 0.01 * k), noise(static_cast<std::uint64_t>(k)));
    const bool has_moved = k >= 30;
    if (k == 30) there.moveCamera(T_other_camera);
    const double dt_s = k == 0 ? 0.0 : kFrameS;
    const Pose expected = here.update(measured, noiseCovariance(), dt_s);
    const Pose told = there.update(has_moved ? T_other_camera * measured : measured, noiseCovariance(), dt_s);
    const Pose back = has_moved ? T_other_camera.inverse() * told : told;
    EXPECT_LT((back.matrix() - expected.matrix()).norm(), 1e-9) << k;
  }
}

TEST(PoseSmootherTest, AnAngleThatIsNotKnownDoesNotHoldTheEstimateBack) {
  Matrix6d covariance = noiseCovariance();
  covariance(3, 3) = 4.0;
  PoseSmoother smoother;
  Pose told;
  for (int k = 0; k < 60; ++k) {
    Pose measured = at(0.0, 0.0);
    if (k >= 30) measured = perturb(measured, 0.1 * Vector6d::Unit(3));
    told = smoother.update(measured, covariance, k == 0 ? 0.0 : kFrameS);
    ASSERT_TRUE(told.matrix().allFinite());
    if (k == 40) {
      EXPECT_NEAR(difference(told, at(0.0, 0.0))[3], 0.1, 0.01);
    }
  }
}

}  // namespace
}  // namespace depth_object_tracker
