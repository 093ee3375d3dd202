// SPDX-License-Identifier: BSD-3-Clause
// The score is told to users as "1 = as the sensor model expects": whatever the object, its distance and what hides it.
#include "tracking_run.h"

#include <gtest/gtest.h>

namespace depth_object_tracker {
namespace {

constexpr int kSettleFrames = 12;
constexpr int kFrames = 15;

double meanScore(TrackingRun& run, const Pose& truth, const std::optional<Board>& board = std::nullopt) {
  run.rest(truth, kSettleFrames, board);
  double sum = 0.0;
  for (int k = 0; k < kFrames; ++k) {
    run.step(truth, board);
    EXPECT_EQ(run.result().state, TrackerState::kTracking);
    sum += run.result().score;
  }
  return sum / kFrames;
}

class Score : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Objects, Score, testing::Values("drill", "bracket", "mug"));

TEST_P(Score, IsOneForTheObjectAsItIsNearAndFar) {
  ScriptedScene scene(GetParam(), 5);
  for (const double away_m : {-0.1, 0.0, 0.3}) {
    const Pose truth = movedBy(restingPose(), 0, 0, away_m);
    TrackingRun run(scene, truth);
    const double score = meanScore(run, truth);
    std::printf("%s %.2f m further: score %.3f\n", GetParam(), away_m, score);
    EXPECT_NEAR(score, 1.0, 0.15);
  }
}

TEST_P(Score, FallsWhenTheMeshIsNotTheObject) {
  ScriptedScene scene(GetParam(), 5);
  ObjectModel wrong = scene.object();
  for (auto& vertex : wrong.mesh.vertices) vertex *= 1.2f;
  TrackerConfig config;
  config.status.lost_below_score = 0.0;  // it is to be told, not searched for
  ObjectTracker tracker(wrong, config);
  tracker.initialise(restingPose());
  TrackerResult result;
  for (int k = 0; k < kSettleFrames + kFrames; ++k) {
    const auto image = scene.render(restingPose());
    result = tracker.update(scene.view(image), scene.camera(), 100.0 + k / 30.0);
  }
  std::printf("%s a fifth too large: score %.3f\n", GetParam(), result.score);
  EXPECT_LT(result.score, 0.85);
}

}  // namespace
}  // namespace depth_object_tracker
