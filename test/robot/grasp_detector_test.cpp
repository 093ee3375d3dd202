// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/robot/grasp_detector.h"

#include <gtest/gtest.h>

#include <limits>

namespace depth_object_tracker {
namespace {

class GraspDetectorTest : public testing::Test {
 protected:
  GraspDetectorTest() : detector_(config()) {}

  static GraspDetectorConfig config() {
    GraspDetectorConfig config;
    config.open_position = 0.1;  // closes towards smaller values
    config.closed_position = 0.0;
    return config;
  }

  /// A second of images; @return the last change, if there was one.
  std::optional<bool> watch(double joint, double speed_m_s, double from_m = 0.1) {
    std::optional<bool> change;
    for (int k = 0; k < 30; ++k) {
      stamp_s_ += 1.0 / 30.0;
      const Pose T_link_object(Eigen::Translation3d(0, 0, from_m + speed_m_s * k / 30.0));
      if (const auto now = detector_.update(stamp_s_, joint, T_link_object)) change = now;
    }
    return change;
  }

  double stamp_s_ = 10.0;
  GraspDetector detector_;
};

TEST_F(GraspDetectorTest, ClosedInPartAboutAnObjectThatMovesAlongHoldsIt) {
  EXPECT_FALSE(watch(0.1, 0.0));   // open
  EXPECT_FALSE(watch(0.05, 0.2));  // the hand moves past
  EXPECT_EQ(watch(0.05, 0.01), std::optional<bool>(true));
  EXPECT_FALSE(watch(0.05, 0.01));  // once
  EXPECT_EQ(watch(0.1, 0.0), std::optional<bool>(false));
}

TEST_F(GraspDetectorTest, ClosedOnNothingOrFarAwayHoldsNothing) {
  EXPECT_FALSE(watch(0.0, 0.0));
  EXPECT_FALSE(watch(0.05, 0.0, 0.5));
  EXPECT_FALSE(watch(std::numeric_limits<double>::quiet_NaN(), 0.0));
}

TEST_F(GraspDetectorTest, AnObjectThatFallsOutIsNotHeld) {
  watch(0.05, 0.0);
  EXPECT_EQ(watch(0.05, 0.8), std::optional<bool>(false));
}

TEST_F(GraspDetectorTest, AMomentDecidesNothingAndWhoKnowsIsBelieved) {
  watch(0.05, 0.0);
  EXPECT_FALSE(detector_.update(stamp_s_ += 0.03, 0.1, Pose(Eigen::Translation3d(0, 0, 0.1))));
  EXPECT_FALSE(watch(0.05, 0.0));
  detector_.setHeld(false);
  EXPECT_EQ(watch(0.05, 0.0), std::optional<bool>(true));
}

TEST(GraspDetector, RefusesSenselessLimits) {
  GraspDetectorConfig config;
  config.open_position = config.closed_position;
  EXPECT_THROW(GraspDetector{config}, std::invalid_argument);
  config = {};
  config.decide_after_s = 0.0;
  EXPECT_THROW(GraspDetector{config}, std::invalid_argument);
}

}  // namespace
}  // namespace depth_object_tracker
