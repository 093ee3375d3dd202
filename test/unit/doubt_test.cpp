// SPDX-License-Identifier: BSD-3-Clause
// When an estimate is compared with other poses of the image, and how often.
#include "depth_object_tracker/tracker/doubt.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace depth_object_tracker {
namespace {

constexpr double kFrameS = 1.0 / 30.0, kGoodScore = 1.0, kPoorScore = 0.7, kPlainSight = 0.9;

/// Runs images that all fit alike. @return times [s] of the looks of a kind.
std::vector<double> looks(Doubt& doubt, double duration_s, double score, Doubt::Look kind) {
  std::vector<double> times;
  for (double time_s = kFrameS; time_s < duration_s; time_s += kFrameS) {
    doubt.update(score, kPlainSight, true, kFrameS);
    const Doubt::Look look = doubt.look();
    if (look == kind) times.push_back(time_s);
    doubt.looked(look);
  }
  return times;
}

TEST(DoubtOf, AGoodFitIsNone) {
  Doubt doubt;
  EXPECT_TRUE(looks(doubt, 10.0, kGoodScore, Doubt::Look::kAround).empty());
  doubt.restart();
  EXPECT_TRUE(looks(doubt, 10.0, kGoodScore, Doubt::Look::kEverywhere).empty());
}

TEST(DoubtOf, APoorFitComesBackEverMoreRarely) {
  Doubt doubt;
  const std::vector<double> times = looks(doubt, 20.0, kPoorScore, Doubt::Look::kEverywhere);
  ASSERT_GE(times.size(), 4u);
  EXPECT_LT(times.front(), 0.2);
  for (std::size_t k = 2; k < times.size(); ++k) {
    EXPECT_GT(times[k] - times[k - 1], 1.2 * (times[k - 1] - times[k - 2])) << k;
  }
}

/// Runs images that all fit alike. @return how many of them were worth comparing with poses nearby.
int comparisons(Doubt& doubt, int images, double score) {
  int count = 0;
  for (int k = 0; k < images; ++k) {
    count += doubt.mayHaveJumped() ? 1 : 0;
    doubt.update(score, kPlainSight, true, kFrameS);
  }
  return count;
}

TEST(DoubtOf, WhatFittedWellMayHaveJumpedInAnyImage) {
  Doubt doubt;
  EXPECT_EQ(comparisons(doubt, 90, kGoodScore), 90);
}

TEST(DoubtOf, WhatFitsBadlyForLongMayHaveJumpedInEveryThirdOrFourthImage) {
  Doubt doubt;
  comparisons(doubt, 90, kGoodScore);
  EXPECT_GE(comparisons(doubt, 9, kPoorScore), 9) << "at first in every image";
  EXPECT_LE(comparisons(doubt, 90, kPoorScore), 36);
  EXPECT_GE(comparisons(doubt, 90, kPoorScore), 22);
}

TEST(DoubtOf, WhatFitsBadlyAndThenWorseMayHaveJumpedJustNow) {
  Doubt doubt;
  comparisons(doubt, 90, kPoorScore);
  EXPECT_LE(comparisons(doubt, 9, kPoorScore), 4);
  doubt.update(kPoorScore - 0.3, kPlainSight, true, kFrameS);
  EXPECT_TRUE(doubt.mayHaveJumped());
  EXPECT_NE(doubt.look(), Doubt::Look::kNowhere);
}

TEST(DoubtOf, LooksAroundGoOnForTwoSecondsButNotInEveryImage) {
  Doubt doubt;
  const std::vector<double> times = looks(doubt, 10.0, kPoorScore, Doubt::Look::kAround);
  ASSERT_GE(times.size(), 10u);
  EXPECT_LE(times.size(), 32u);
  EXPECT_LT(times.back(), 2.2);
}

TEST(DoubtOf, AFindIsFiveLooksAtAllOfTheImageHoweverWellItFits) {
  Doubt doubt;
  doubt.update(kGoodScore, kPlainSight, true, kFrameS);
  doubt.found();
  const std::vector<double> times = looks(doubt, 20.0, kGoodScore, Doubt::Look::kEverywhere);
  ASSERT_EQ(times.size(), 5u);
  for (std::size_t k = 0; k < times.size(); ++k) {
    EXPECT_NEAR(times[k], 0.2 * std::exp2(static_cast<double>(k)), 2.0 * kFrameS);
  }
}

TEST(DoubtOf, AFindThatIsOddByItselfGoesOnUntilItIsSurelySeen) {
  constexpr double kOddNat = -4.0, kSureNat = 3.0, kMiddlingNat = 0.0;
  Doubt doubt;
  doubt.judged(kOddNat);
  EXPECT_TRUE(looks(doubt, 10.0, kGoodScore, Doubt::Look::kEverywhere).empty()) << "what was given is believed";
  doubt.found();
  EXPECT_TRUE(doubt.isUnproven());
  doubt.judged(kOddNat);
  const std::vector<double> times = looks(doubt, 10.0, kGoodScore, Doubt::Look::kEverywhere);
  EXPECT_GE(times.size(), 8u);
  EXPECT_LT(times.front(), 0.5);
  doubt.judged(kMiddlingNat);
  EXPECT_TRUE(doubt.isUnproven());
  EXPECT_TRUE(looks(doubt, 10.0, kGoodScore, Doubt::Look::kEverywhere).empty());
  doubt.judged(kSureNat);
  EXPECT_FALSE(doubt.isUnproven());
  doubt.judged(kOddNat);
  EXPECT_TRUE(looks(doubt, 10.0, kGoodScore, Doubt::Look::kEverywhere).empty()) << "it was seen to be the object";
}

}  // namespace
}  // namespace depth_object_tracker
