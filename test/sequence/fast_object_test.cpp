// SPDX-License-Identifier: BSD-3-Clause
// A thin object starts to move at up to 1 m/s, along the arm that holds it.
#include "followed_scene.h"

#include <gtest/gtest.h>

namespace depth_object_tracker {
namespace {

class AFastObject : public testing::TestWithParam<SceneCase> {};
INSTANTIATE_TEST_SUITE_P(Objects, AFastObject, testing::Values(SceneCase{"spatula", 2913}, SceneCase{"spatula", 3513}));

TEST_P(AFastObject, IsNotLostOnTheArm) {
  constexpr int kImages = 120;
  constexpr double kLostM = 0.05;
  SimulationConfig config;
  config.speed = Speed::kFast;
  config.seed = GetParam().seed;
  int lost = 0;
  const double last_m =
      followScene(GetParam().object, config, kImages,
                  [&](const SimulatedFrame&, const TrackerResult&, double off_m) { lost += off_m > kLostM ? 1 : 0; });
  EXPECT_LE(lost, 4);
  EXPECT_LT(last_m, 0.005);
}

}  // namespace
}  // namespace depth_object_tracker
