// SPDX-License-Identifier: BSD-3-Clause
// Poses that look better than the right one: a finger where the mug's handle could be.
#include "depth_object_tracker/tracker/illusions.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace depth_object_tracker {
namespace {

constexpr double kFrameS = 1.0 / 30.0;

Pose turned(double angle_rad) {
  Pose T = Pose::Identity();
  T.linear() = Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return T;
}

Illusions learnt(double angle_rad, double nat, double duration_s) {
  Illusions illusions;
  for (double time_s = 0.0; time_s < duration_s; time_s += kFrameS) illusions.learn(turned(angle_rad), nat, kFrameS);
  return illusions;
}

TEST(AnIllusion, IsLearntSlowerThanAHandleComesIntoView) {
  EXPECT_LT(learnt(2.0, 12.0, 0.2).known(turned(2.0)), 4.0);
  EXPECT_NEAR(learnt(2.0, 12.0, 3.0).known(turned(2.1)), 12.0, 0.5);
}

TEST(AnIllusion, IsKnownOnlyWhereItIs) {
  EXPECT_EQ(learnt(2.0, 12.0, 3.0).known(turned(1.2)), 0.0);
  EXPECT_EQ(Illusions().known(turned(2.0)), 0.0);
}

TEST(AnIllusion, StaysWhereItIsWhenTheEstimateTurns) {
  Illusions illusions = learnt(2.0, 12.0, 3.0);
  illusions.moved(turned(-0.7));
  EXPECT_GT(illusions.known(turned(2.7)), 11.0);
  EXPECT_EQ(illusions.known(turned(2.0)), 0.0);
}

TEST(AnIllusion, EndsWhenTheFingerIsGone) {
  Illusions illusions = learnt(2.0, 12.0, 3.0);
  for (int k = 0; k < 60; ++k) illusions.fade(turned(2.0), -1.0, kFrameS);
  EXPECT_LT(illusions.known(turned(2.0)), 1.0);
}

TEST(AnIllusion, IsForgottenInTime) {
  Illusions illusions = learnt(2.0, 12.0, 3.0);
  illusions.age(5.0);
  EXPECT_NEAR(illusions.known(turned(2.0)), 6.0, 0.5);
  illusions.age(60.0);
  EXPECT_EQ(illusions.known(turned(2.0)), 0.0);
}

TEST(AnIllusion, IsNoneThatIsTooGood) {
  EXPECT_LT(learnt(2.0, 60.0, 5.0).known(turned(2.0)), 25.0) << "then it is the estimate that is contradicted";
}

TEST(AnIllusion, WhatSpeaksAgainstAPoseIsNone) {
  EXPECT_EQ(learnt(2.0, -3.0, 1.0).known(turned(2.0)), 0.0);
}

}  // namespace
}  // namespace depth_object_tracker
