// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/robot/twist_buffer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace depth_object_tracker {
namespace {

TwistSample sample(double stamp_s, double vx, double wz = 0.0) {
  return {stamp_s, Eigen::Vector3d(vx, 0.0, 0.0), Eigen::Vector3d(0.0, 0.0, wz)};
}

TEST(TwistBuffer, OneSampleAnImageIsTheMotionUpToThatImage) {
  TwistBuffer buffer;
  for (int i = 0; i < 5; ++i) buffer.add(sample(i / 30.0, i, -i));
  const auto mean = buffer.mean(2 / 30.0, 3 / 30.0);
  ASSERT_TRUE(mean);
  EXPECT_NEAR(mean->linear_m_s.x(), 3.0, 1e-9);
  EXPECT_NEAR(mean->angular_rad_s.z(), -3.0, 1e-9);
}

TEST(TwistBuffer, WeighsSamplesByTheTimeThatTheyCover) {
  TwistBuffer buffer;
  buffer.add(sample(0.00, 9.0));
  buffer.add(sample(0.01, 1.0));
  buffer.add(sample(0.04, 5.0));
  EXPECT_NEAR(buffer.mean(0.0, 0.04)->linear_m_s.x(), (0.01 * 1.0 + 0.03 * 5.0) / 0.04, 1e-9);
  EXPECT_NEAR(buffer.mean(0.005, 0.02)->linear_m_s.x(), (0.005 * 1.0 + 0.01 * 5.0) / 0.015, 1e-9);
}

TEST(TwistBuffer, IntegratesASineAsTheIntegralDoes) {
  TwistBuffer buffer;
  for (int i = 0; i <= 1000; ++i) buffer.add(sample(i * 0.001, std::sin(6.0 * i * 0.001)));
  const double expected = (std::cos(6.0 * 0.3) - std::cos(6.0 * 0.4)) / 6.0 / 0.1;
  EXPECT_NEAR(buffer.mean(0.3, 0.4)->linear_m_s.x(), expected, 0.01);
}

TEST(TwistBuffer, HoldsTheNewestForAWhileAndThenKnowsNothing) {
  TwistBuffer buffer(0.1);
  buffer.add(sample(1.0, 2.0));
  EXPECT_NEAR(buffer.mean(1.0, 1.03)->linear_m_s.x(), 2.0, 1e-9);
  EXPECT_FALSE(buffer.mean(1.2, 1.233));
  EXPECT_FALSE(TwistBuffer().mean(0.0, 1.0));
}

TEST(TwistBuffer, NeedsHalfOfTheIntervalCovered) {
  TwistBuffer buffer(0.1);
  buffer.add(sample(0.5, 1.0));
  buffer.add(sample(0.6, 1.0));  // together 0.4 to 0.7
  EXPECT_TRUE(buffer.mean(0.4, 0.9));
  EXPECT_FALSE(buffer.mean(0.0, 1.0));
}

TEST(TwistBuffer, SortsLateSamplesAndReplacesRepeatedOnes) {
  TwistBuffer buffer;
  buffer.add(sample(0.00, 0.0));
  buffer.add(sample(0.02, 2.0));
  buffer.add(sample(0.01, 1.0));
  buffer.add(sample(0.02, 4.0));
  EXPECT_NEAR(buffer.mean(0.0, 0.02)->linear_m_s.x(), 2.5, 1e-9);
}

TEST(TwistBuffer, StartsAnewWhenTimeJumpsBack) {
  TwistBuffer buffer;
  buffer.add(sample(100.0, 9.0));
  buffer.add(sample(90.0, 1.0));
  EXPECT_EQ(*buffer.newestStamp(), 90.0);
  EXPECT_NEAR(buffer.mean(89.97, 90.0)->linear_m_s.x(), 1.0, 1e-9);
}

TEST(TwistBuffer, RefusesNumbersThatAreNotFinite) {
  TwistBuffer buffer;
  EXPECT_FALSE(buffer.add(sample(0.0, std::numeric_limits<double>::quiet_NaN())));
  EXPECT_FALSE(buffer.add(sample(std::numeric_limits<double>::infinity(), 1.0)));
  EXPECT_FALSE(buffer.newestStamp());
}

TEST(TwistBuffer, StaysSmall) {
  TwistBuffer buffer;
  for (int i = 0; i < 100000; ++i) buffer.add(sample(i * 1e-5, 1.0));
  EXPECT_FALSE(buffer.mean(0.0, 0.1));  // forgotten
  EXPECT_TRUE(buffer.mean(0.99, 1.0));
}

}  // namespace
}  // namespace depth_object_tracker
