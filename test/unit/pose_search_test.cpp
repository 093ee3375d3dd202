// SPDX-License-Identifier: BSD-3-Clause
// How far an object may have gone while it was hidden.
#include "depth_object_tracker/tracker/pose_search.h"

#include <gtest/gtest.h>

#include <cmath>

namespace depth_object_tracker {
namespace {

Vector6d moving(double speed_mps, double rate_radps) {
  Vector6d velocity = Vector6d::Zero();
  velocity.head<3>() = Eigen::Vector3d(0.6, -0.8, 0.0) * speed_mps;
  velocity.tail<3>() = Eigen::Vector3d(0.0, 0.0, 1.0) * rate_radps;
  return velocity;
}

TEST(WhileHidden, AnObjectGoesOnInSomeDirectionAtTheSpeedThatItHad) {
  constexpr double kSpeed = 1.0, kRate = 3.0, kShortS = 0.1;
  const Vector6d variances = hiddenVariances(moving(kSpeed, kRate), kShortS);
  EXPECT_NEAR(std::sqrt(variances.head<3>().sum()), kSpeed * kShortS, 0.1 * kSpeed * kShortS);
  EXPECT_NEAR(std::sqrt(variances.tail<3>().sum()), kRate * kShortS, 0.1 * kRate * kShortS);
}

TEST(WhileHidden, TheSpreadStartsAtNothingGrowsAndEnds) {
  Vector6d before = hiddenVariances(moving(0.3, 1.0), 0.0);
  EXPECT_EQ(before, Vector6d::Zero());
  for (const double hidden_s : {0.1, 0.5, 1.0, 3.0}) {
    const Vector6d variances = hiddenVariances(moving(0.3, 1.0), hidden_s);
    EXPECT_TRUE((variances.array() > before.array()).all()) << hidden_s;
    before = variances;
  }
  EXPECT_LT(std::sqrt(hiddenVariances(moving(0.3, 1.0), 1e6)[0]), 0.3) << "nothing is held in the hand for ever";
}

TEST(WhileHidden, WhatLayStillMayBeTakenUp) {
  EXPECT_GT(std::sqrt(hiddenVariances(Vector6d::Zero(), 1.0)[0]), 0.01);
}

}  // namespace
}  // namespace depth_object_tracker
