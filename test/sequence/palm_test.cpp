// SPDX-License-Identifier: BSD-3-Clause
// A gripper holds the object and hides most of it from the first image on; its palm explains more of the image than
// what is left of the object.
#include "followed_scene.h"

#include <gtest/gtest.h>

namespace depth_object_tracker {
namespace {

class APalm : public testing::TestWithParam<SceneCase> {};
INSTANTIATE_TEST_SUITE_P(Objects, APalm,
                         testing::Values(SceneCase{"bracket", 3210}, SceneCase{"mug", 101}, SceneCase{"mug", 103}));

TEST_P(APalm, IsNotTakenForTheObjectBeforeIt) {
  constexpr int kImages = 120;
  constexpr double kElsewhereM = 0.015;
  SimulationConfig config;
  config.scenario = Scenario::kRobot;
  config.hand_coverage = 0.8;
  config.seed = GetParam().seed;
  int elsewhere = 0;
  const double last_m = followScene(
      GetParam().object, config, kImages, [&](const SimulatedFrame&, const TrackerResult& result, double off_m) {
        elsewhere += result.state == TrackerState::kTracking && off_m > kElsewhereM ? 1 : 0;
      });
  EXPECT_LE(elsewhere, 3);
  EXPECT_LT(last_m, 0.005);
}

}  // namespace
}  // namespace depth_object_tracker
