// SPDX-License-Identifier: BSD-3-Clause
// A hand holds the object; a board hides it, but not the arm, which is about as round as the object.
#include "followed_scene.h"

#include <gtest/gtest.h>

namespace depth_object_tracker {
namespace {

struct ArmCase {
  SceneCase scene;
  int images;  // until it was hidden once and is seen again
};
std::ostream& operator<<(std::ostream& out, const ArmCase& tested) {
  return out << tested.scene;
}

class AnArm : public testing::TestWithParam<ArmCase> {};
INSTANTIATE_TEST_SUITE_P(Objects, AnArm, testing::Values(ArmCase{{"mug", 2501}, 115}, ArmCase{{"bottle", 2505}, 120}));

TEST_P(AnArm, IsNotTakenForTheObjectThatItHolds) {
  constexpr double kElsewhereM = 0.05, kSeenShare = 0.5;
  SimulationConfig config;
  config.occluders = Occluders::kFull;
  config.seed = GetParam().scene.seed;
  int hidden = 0, elsewhere = 0;
  double seen_share = 0.0;
  const double last_m = followScene(GetParam().scene.object, config, GetParam().images,
                                    [&](const SimulatedFrame& frame, const TrackerResult& result, double off_m) {
                                      hidden += frame.visible_pixels == 0 ? 1 : 0;
                                      elsewhere +=
                                          result.state == TrackerState::kTracking && off_m > kElsewhereM ? 1 : 0;
                                      seen_share = frame.visibleFraction();
                                    });
  EXPECT_GT(seen_share, kSeenShare) << "at the end";
  EXPECT_GT(hidden, 15);
  EXPECT_LE(elsewhere, 2);
  EXPECT_LT(last_m, 0.01);
}

// The object comes back where it is not expected, a moment after the arm was taken for it.
TEST(AnArmThatWasFound, IsLeftSoonAfterTheObjectIsBack) {
  constexpr int kImages = 110;
  constexpr double kElsewhereM = 0.05;
  SimulationConfig config;
  config.occluders = Occluders::kFull;
  config.seed = 3701;
  int elsewhere = 0;
  const double last_m =
      followScene("mug", config, kImages, [&](const SimulatedFrame&, const TrackerResult& result, double off_m) {
        elsewhere += result.state == TrackerState::kTracking && off_m > kElsewhereM ? 1 : 0;
      });
  EXPECT_LE(elsewhere, 15);  // the object is in full view from the fifth of them on
  EXPECT_LT(last_m, 0.01);
}

}  // namespace
}  // namespace depth_object_tracker
