// SPDX-License-Identifier: BSD-3-Clause
// A small high peak beside a broad lower one.
#include "depth_object_tracker/tracker/pose_sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

constexpr double kPeakStddevM = 0.002, kPeakStddevRad = 0.03, kBroad = 6.0;

Vector6d displacement(double position_m, double angle_rad) {
  Vector6d vector;
  vector << position_m, -position_m, 0.5 * position_m, angle_rad, 0.0, -angle_rad;
  return vector;
}

double squared(const Vector6d& apart, double stddev_m, double stddev_rad) {
  return apart.head<3>().squaredNorm() / (stddev_m * stddev_m) +
         apart.tail<3>().squaredNorm() / (stddev_rad * stddev_rad);
}

const Pose kMiddle = Pose::Identity();
const Pose kPeak = perturb(kMiddle, displacement(0.004, 0.05));
const Pose kBroadPeak = perturb(kMiddle, displacement(-0.008, -0.1));

double value(const Pose& pose, double width_m, int) {
  const double wider = 1.0 + width_m / kPeakStddevM;
  const double peak = -0.5 * squared(difference(pose, kPeak), wider * kPeakStddevM, wider * kPeakStddevRad);
  const double broad =
      -5.0 - 0.5 * squared(difference(pose, kBroadPeak), kBroad * kPeakStddevM, kBroad * kPeakStddevRad);
  return std::max(peak, broad);
}

Pose stays(const Pose& pose, int) {
  return pose;
}

Vector6d variances() {
  Vector6d variances;
  variances.head<3>().setConstant(0.01 * 0.01);
  variances.tail<3>().setConstant(0.15 * 0.15);
  return variances;
}

TEST(PoseSamplerOf, ASmallPeakFindsItMoreOftenThanNot) {
  constexpr int kSeeds = 40;
  WorkerPool pool(1);
  int found = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    PoseSampler sampler(static_cast<std::uint64_t>(seed), pool);
    const Pose highest = sampler.highest(kMiddle, variances(), value, stays, 0);
    found += squared(difference(highest, kPeak), kPeakStddevM, kPeakStddevRad) < 9.0 ? 1 : 0;
  }
  EXPECT_GT(found, kSeeds / 2);
}

TEST(PoseSamplerOf, APeakThatIsClimbedEndsAtItsTop) {
  WorkerPool pool(1);
  PoseSampler sampler(1, pool);
  const auto climb = [](const Pose&, int) { return kPeak; };
  const Pose highest = sampler.highest(kMiddle, variances(), value, climb, 0);
  EXPECT_LT(difference(highest, kPeak).norm(), 1e-12);
}

TEST(PoseSamplerOf, AClimbThatEndsLowerIsLeftOut) {
  WorkerPool pool(1);
  PoseSampler sampler(1, pool);
  const auto climb = [](const Pose&, int) { return perturb(kPeak, displacement(1.0, 1.0)); };
  const Pose highest = sampler.highest(kMiddle, variances(), value, climb, 0);
  EXPECT_GT(value(highest, 0.0, 0), -10.0);
}

TEST(PoseSamplerOf, OneSeedGivesTheSameOnAnyNumberOfThreads) {
  WorkerPool one(1), four(4);
  const Pose first = PoseSampler(7, one).highest(kMiddle, variances(), value, stays, 100);
  const Pose second = PoseSampler(7, four).highest(kMiddle, variances(), value, stays, 100);
  EXPECT_EQ((first.matrix() - second.matrix()).cwiseAbs().maxCoeff(), 0.0);
  const Pose other = PoseSampler(7, one).highest(kMiddle, variances(), value, stays, 100 + PoseSampler::numDraws());
  EXPECT_NE((first.matrix() - other.matrix()).cwiseAbs().maxCoeff(), 0.0) << "other draws";
}

}  // namespace
}  // namespace depth_object_tracker
