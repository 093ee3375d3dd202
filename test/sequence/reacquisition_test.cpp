// SPDX-License-Identifier: BSD-3-Clause
// Finding an object that nothing, or something wrong, is known of.
#include "tracking_run.h"

#include <gtest/gtest.h>

namespace depth_object_tracker {
namespace {

class Reacquired : public testing::TestWithParam<const char*> {
 protected:
  Reacquired() : scene_(GetParam(), 5) {}

  ScriptedScene scene_;
};
INSTANTIATE_TEST_SUITE_P(Objects, Reacquired, testing::Values("drill", "mug", "bracket"));

TEST_P(Reacquired, AnObjectIsFoundWithoutAnInitialPose) {
  TrackingRun run(scene_, restingPose());
  run.tracker().initialiseAnywhere();
  int frames = 0;
  do {
    run.step(restingPose());
    if (run.result().state != TrackerState::kTracking) {
      EXPECT_EQ(run.result().state, TrackerState::kInitializing);
      EXPECT_FALSE(run.result().has_pose) << "no pose before there is one";
      EXPECT_FALSE(run.result().reason.empty());
    }
  } while (run.result().state != TrackerState::kTracking && ++frames < 60);
  run.rest(restingPose(), 6);
  EXPECT_EQ(run.result().state, TrackerState::kTracking);
  EXPECT_TRUE(run.result().has_pose);
  EXPECT_LT(run.lastError(), 0.004);
}

TEST_P(Reacquired, NothingIsFoundWhereTheObjectIsNot) {
  TrackingRun run(scene_, restingPose());
  run.tracker().initialiseAnywhere();
  for (int k = 0; k < 10; ++k) {
    run.step(std::nullopt, Board{100, 220, 0.7});
    EXPECT_EQ(run.result().state, TrackerState::kInitializing) << "a board is not the object";
  }
}

TEST_P(Reacquired, AnObjectThatIsSuddenlyElsewhereIsReportedLostAndFound) {
  TrackingRun run(scene_, restingPose());
  run.rest(restingPose(), 8);
  const Pose elsewhere = movedBy(restingPose(), 0.16, -0.05, 0.08, {0.3, 0.4, 0.5});
  int tracking_wrongly = 0, frames_to_find = 0;
  for (int k = 1; k <= 60; ++k) {
    run.step(elsewhere);
    const bool is_right = run.lastError() < 0.01;
    tracking_wrongly += run.result().state == TrackerState::kTracking && !is_right ? 1 : 0;
    if (frames_to_find == 0 && is_right) frames_to_find = k;
  }
  EXPECT_LE(tracking_wrongly, 10);
  EXPECT_GT(frames_to_find, 0);
  EXPECT_EQ(run.result().state, TrackerState::kTracking);
  EXPECT_LT(run.lastError(), 0.004);
}

}  // namespace
}  // namespace depth_object_tracker
