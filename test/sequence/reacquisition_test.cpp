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

/// An estimate that has gone astray: the tracker believes firmly in a wrong pose.
class Astray : public testing::TestWithParam<const char*> {
 protected:
  /// @return images until the estimate is within 1 cm and stays there for three images; 0 = not within three seconds.
  int imagesUntilFound(const Pose& believed) {
    ScriptedScene scene(GetParam(), 6);
    TrackingRun run(scene, restingPose());
    Matrix6d covariance = Matrix6d::Identity();
    covariance.diagonal().head<3>().setConstant(0.002 * 0.002);
    covariance.diagonal().tail<3>().setConstant(0.02 * 0.02);
    run.tracker().initialise(believed, covariance);
    wrong_as_tracking_ = 0;
    int right = 0;
    for (int k = 1; k <= 90; ++k) {
      run.step(restingPose());
      right = run.lastError() < 0.01 ? right + 1 : 0;
      wrong_as_tracking_ += right == 0 && run.result().state == TrackerState::kTracking ? 1 : 0;
      if (right == 3) return k - 2;
    }
    return 0;
  }

  int wrong_as_tracking_ = 0;
};
INSTANTIATE_TEST_SUITE_P(Objects, Astray, testing::Values("drill", "mug", "bracket", "spatula"));

TEST_P(Astray, DriftedByThreeCentimetresItComesBack) {
  for (int axis = 0; axis < 3; ++axis) {
    Pose believed = restingPose();
    believed.translation()[axis] += 0.03;
    const int images = imagesUntilFound(believed);
    EXPECT_GT(images, 0) << "axis " << axis;
    EXPECT_LE(images, 15) << "axis " << axis;
    EXPECT_LE(wrong_as_tracking_, 10) << "axis " << axis;
  }
}

TEST_P(Astray, TurnedByARightAngleItComesBack) {
  for (int axis = 0; axis < 3; ++axis) {
    const Pose believed = movedBy(restingPose(), 0, 0, 0, M_PI_2 * Eigen::Vector3d::Unit(axis));
    EXPECT_GT(imagesUntilFound(believed), 0) << "axis " << axis;
  }
}

TEST_P(Astray, TurnedByARightAngleItSaysSoAndComesBackWithinTwoSeconds) {
  for (int axis = 0; axis < 3; ++axis) {
    const int images = imagesUntilFound(movedBy(restingPose(), 0, 0, 0, M_PI_2 * Eigen::Vector3d::Unit(axis)));
    EXPECT_LE(images, 60) << "axis " << axis;
    EXPECT_LE(wrong_as_tracking_, 10) << "axis " << axis;
  }
}

}  // namespace
}  // namespace depth_object_tracker
