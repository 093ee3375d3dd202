// SPDX-License-Identifier: BSD-3-Clause
// What is believed of an angle, against closed forms.
#include "depth_object_tracker/tracker/angle_belief.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace depth_object_tracker {
namespace {

constexpr double kStepRad = 2.0 * M_PI / AngleBelief::kSteps;

TEST(BelievedAngle, SpreadsAsVariancesAdd) {
  AngleBelief belief;
  belief.restart(0.2);
  for (int k = 0; k < 50; ++k) belief.diffuse(1e-3);
  belief.diffuse(0.05);
  EXPECT_NEAR(belief.moments().variance, 0.04 + 0.05 + 0.05, 1e-6);
  EXPECT_NEAR(belief.moments().mean, 0.0, 1e-9);
}

TEST(BelievedAngle, IsTakenAlongByNoTurnOfTheEstimate) {
  AngleBelief belief;
  belief.restart(0.3);
  belief.turnEstimate(0.123);
  EXPECT_NEAR(belief.moments().mean, -0.123, 1e-6);
  belief.turnEstimate(3.0 * M_PI);
  EXPECT_NEAR(belief.moments().mean, wrappedAngle(-0.123 - 3.0 * M_PI), 1e-6);
}

TEST(BelievedAngle, OfNothingKnownIsSpreadEvenly) {
  AngleBelief belief;
  belief.restart(std::numeric_limits<double>::infinity());
  EXPECT_NEAR(belief.moments().variance, M_PI * M_PI / 3.0, 0.01);
  EXPECT_EQ(belief.moments().mean, 0.0) << "no direction is likelier";
  EXPECT_DOUBLE_EQ(belief.near(2.0), 1.0 / AngleBelief::kSteps);
}

TEST(BelievedAngle, IsWhereItIsNotContradictedAndStaysAsWide) {
  AngleBelief belief;
  belief.restart(std::numeric_limits<double>::infinity());
  // Between -0.5 and 1.5; images that say the same thing again do not make it narrower.
  for (int image = 0; image < 40; ++image)
    belief.weigh([](double angle) { return angle < -0.5 || angle > 1.5 ? 6.0 : 0.0; });
  EXPECT_NEAR(belief.moments().mean, 0.5, 0.5 * kStepRad);
  EXPECT_NEAR(std::sqrt(belief.moments().variance), 2.0 / std::sqrt(12.0), 0.05);
}

TEST(BelievedAngle, ComesBackFromWhatWasRuledOut) {
  AngleBelief belief;
  belief.restart(0.1);
  for (int image = 0; image < 4; ++image)
    belief.weigh([](double angle) { return std::abs(angle - 2.0) > 0.3 ? 6.0 : 0.0; });
  EXPECT_NEAR(belief.moments().mean, 2.0, 0.1);
}

TEST(WrappedAngles, AreTheSameTurn) {
  for (const double angle : {-9.0, -M_PI, -1.0, 0.0, 3.0, 12.5}) {
    const double wrapped = wrappedAngle(angle);
    EXPECT_GE(wrapped, -M_PI);
    EXPECT_LT(wrapped, M_PI);
    EXPECT_NEAR(std::cos(wrapped), std::cos(angle), 1e-12);
    EXPECT_NEAR(std::sin(wrapped), std::sin(angle), 1e-12);
  }
}

}  // namespace
}  // namespace depth_object_tracker
