// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/frame_budget.h"

#include <gtest/gtest.h>

#include <limits>

namespace depth_object_tracker {
namespace {

constexpr double kBudgetS = 0.03;

/// A machine on which a frame of full effort takes `full_s`, of which `fixed_s` do not depend on the effort.
double settle(FrameBudget& budget, double full_s, double fixed_s, int frames) {
  double took_s = 0.0;
  for (int k = 0; k < frames; ++k) {
    took_s = fixed_s + (full_s - fixed_s) * budget.effort();
    budget.frameTook(took_s);
  }
  return took_s;
}

BudgetConfig config(double budget_s) {
  BudgetConfig result;
  result.frame_budget_s = budget_s;
  return result;
}

TEST(FrameBudget, FastFramesKeepTheFullEffort) {
  FrameBudget budget(config(kBudgetS));
  settle(budget, 0.5 * kBudgetS, 0.0, 50);
  EXPECT_EQ(budget.effort(), 1.0);
}

TEST(FrameBudget, SlowFramesAreBroughtUnderTheBudgetAndKeptNearIt) {
  for (const double slowness : {1.5, 4.0, 10.0}) {
    FrameBudget budget(config(kBudgetS));
    settle(budget, slowness * kBudgetS, 0.1 * kBudgetS, 60);
    for (int k = 0; k < 40; ++k) {
      const double took_s = settle(budget, slowness * kBudgetS, 0.1 * kBudgetS, 1);
      EXPECT_LE(took_s, 1.05 * kBudgetS) << slowness;
      EXPECT_GE(took_s, 0.6 * kBudgetS) << slowness;
    }
  }
}

TEST(FrameBudget, TheFirstSlowFramesAreAnsweredWithinAFewFrames) {
  FrameBudget budget(config(kBudgetS));
  EXPECT_LE(settle(budget, 3.0 * kBudgetS, 0.0, 6), kBudgetS);
}

TEST(FrameBudget, EffortComesBackWhenTheMachineIsFreeAgain) {
  FrameBudget budget(config(kBudgetS));
  settle(budget, 10.0 * kBudgetS, 0.0, 50);
  ASSERT_LT(budget.effort(), 0.2);
  settle(budget, 0.3 * kBudgetS, 0.0, 100);
  EXPECT_EQ(budget.effort(), 1.0);
}

TEST(FrameBudget, EffortHasALowerLimit) {
  FrameBudget budget(config(kBudgetS));
  settle(budget, 1e6, 1e5, 100);
  EXPECT_GE(budget.effort(), 0.01);
  EXPECT_LE(budget.effort(), 0.1);
}

TEST(FrameBudget, ZeroMeansNoBudget) {
  FrameBudget budget(config(0.0));
  settle(budget, 100.0, 0.0, 20);
  EXPECT_EQ(budget.effort(), 1.0);
}

TEST(FrameBudget, TimesThatAreNoneAreIgnored) {
  FrameBudget budget(config(kBudgetS));
  for (const double seconds : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) budget.frameTook(seconds);
  EXPECT_EQ(budget.effort(), 1.0);
}

}  // namespace
}  // namespace depth_object_tracker
