// SPDX-License-Identifier: BSD-3-Clause
// Following an object at rest, in motion, stopping, hidden and gone. Error bounds are several times what is usual.
#include "tracking_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace depth_object_tracker {
namespace {

constexpr int kSettleFrames = 12;

double positionStddev(const TrackerResult& result) {
  return std::sqrt(result.covariance.topLeftCorner<3, 3>().trace());
}

class Motion : public testing::Test {
 protected:
  ScriptedScene scene_{"drill", 3};
};

/// The cases that depend most on what the object looks like.
class MotionOf : public testing::TestWithParam<const char*> {
 protected:
  MotionOf() : scene_(GetParam(), 3) {}
  ScriptedScene scene_;
};
INSTANTIATE_TEST_SUITE_P(Objects, MotionOf, testing::Values("drill", "bracket"));

TEST_P(MotionOf, AnObjectAtRestIsHeldStill) {
  TrackingRun run(scene_, restingPose());
  run.rest(restingPose(), kSettleFrames);
  run.startJudging();
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Vector3d> rotations;
  for (int k = 0; k < 30; ++k) {
    run.step(restingPose());
    positions.push_back(run.result().T_camera_object.translation());
    rotations.push_back(difference(run.result().T_camera_object, restingPose()).tail<3>());
    EXPECT_EQ(run.result().state, TrackerState::kTracking);
    EXPECT_LT(run.result().twist.head<3>().norm(), 0.005);
  }
  Eigen::Vector3d mean = Eigen::Vector3d::Zero(), mean_rotation = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < positions.size(); ++k) {
    mean += positions[k] / 30.0;
    mean_rotation += rotations[k] / 30.0;
  }
  double jitter = 0.0, rotation_jitter = 0.0;
  for (std::size_t k = 0; k < positions.size(); ++k) {
    jitter += (positions[k] - mean).squaredNorm() / 30.0;
    rotation_jitter += (rotations[k] - mean_rotation).squaredNorm() / 30.0;
  }
  run.print("at rest");
  std::printf("jitter %.2f mm, %.2f deg\n", 1e3 * std::sqrt(jitter), std::sqrt(rotation_jitter) * 180.0 / M_PI);
  EXPECT_LT(run.medianError(), 0.0005);
  EXPECT_LT(std::sqrt(jitter), 0.00015);
  EXPECT_LT(std::sqrt(rotation_jitter) * 180.0 / M_PI, 0.1);
}

TEST_F(Motion, ConstantVelocityIsFollowed) {
  Pose truth = movedBy(restingPose(), -0.12, 0, 0);
  TrackingRun run(scene_, truth);
  run.rest(truth, kSettleFrames);
  run.startJudging();
  for (int k = 0; k < 30; ++k) {
    truth = movedBy(truth, 0.25 / 30.0, -0.05 / 30.0, 0.1 / 30.0, {0, 0.5 / 30.0, 0.3 / 30.0});
    run.step(truth);
  }
  run.print("constant velocity");
  EXPECT_LT(run.medianError(), 0.005);
  EXPECT_LT(run.largestError(), 0.02);
  EXPECT_EQ(run.lostFrames(), 0);
  // With the rotation the mesh origin's own velocity is the given one.
  EXPECT_LT((run.result().twist.head<3>() - Eigen::Vector3d(0.25, -0.05, 0.1)).norm(), 0.15);
}

TEST_F(Motion, ASuddenStopIsNotOvershot) {
  Pose truth = movedBy(restingPose(), -0.1, 0, 0);
  TrackingRun run(scene_, truth);
  run.rest(truth, kSettleFrames);
  for (int k = 0; k < 15; ++k) {
    truth = movedBy(truth, 0.4 / 30.0, 0, 0);
    run.step(truth);
  }
  run.startJudging();
  run.rest(truth, 15);
  run.print("stop from 0.4 m/s");
  EXPECT_LT(run.largestError(), 0.02);
  EXPECT_LT(run.lastError(), 0.004);
  EXPECT_EQ(run.lostFrames(), 0);
}

TEST_F(Motion, TenImagesASecondAreEnough) {
  Pose truth = movedBy(restingPose(), -0.08, 0, 0);
  TrackingRun run(scene_, truth);
  for (int k = 0; k < 6; ++k) run.step(truth, std::nullopt, 0.1);
  run.startJudging();
  for (int k = 0; k < 15; ++k) {
    truth = movedBy(truth, 0.012, 0.004, 0, {0, 0, 0.04});
    run.step(truth, std::nullopt, 0.1);
  }
  run.print("10 Hz, 0.13 m/s");
  EXPECT_LT(run.medianError(), 0.005);
  EXPECT_LT(run.largestError(), 0.02);
  EXPECT_EQ(run.lostFrames(), 0);
}

TEST_P(MotionOf, ASweepingOccluderMovesNothing) {
  TrackingRun run(scene_, restingPose());
  run.rest(restingPose(), kSettleFrames);
  run.startJudging();
  const auto [left, right] = scene_.columnsOf(restingPose());
  const int width = (right - left) * 6 / 10;
  double least_visible = 1.0;
  for (int k = 0; k <= 30; ++k) {
    const int begin = left - width + (right - left + width) * k / 30;
    run.step(restingPose(), Board{begin, begin + width, 0.55});
    least_visible = std::min(least_visible, run.result().visible_fraction);
  }
  run.print("occluder sweep");
  EXPECT_LT(run.medianError(), 0.005);
  EXPECT_LT(run.largestError(), 0.02);
  EXPECT_EQ(run.lostFrames(), 0);
  EXPECT_LT(least_visible, 0.75) << "the board must be noticed";
  run.rest(restingPose(), 6);
  EXPECT_GT(run.result().visible_fraction, 0.8);
  EXPECT_LT(run.lastError(), 0.004);
}

TEST_P(MotionOf, AHiddenObjectIsHeldWithGrowingUncertaintyAndFoundAgain) {
  TrackingRun run(scene_, restingPose());
  run.rest(restingPose(), kSettleFrames);
  const double stddev_before = positionStddev(run.result());
  run.startJudging();
  // A board slides in from the left within a quarter of a second, stays, and goes back.
  const auto [left, right] = scene_.columnsOf(restingPose());
  const int begin = left - 60, reach = right - left + 120;
  for (int k = 1; k <= 8; ++k) run.step(restingPose(), Board{begin, begin + reach * k / 8, 0.55});
  run.rest(restingPose(), 20, Board{begin, begin + reach, 0.55});
  run.print("hidden");
  EXPECT_EQ(run.result().state, TrackerState::kOccluded);
  EXPECT_FALSE(run.result().reason.empty());
  EXPECT_TRUE(run.result().has_pose);
  EXPECT_LT(run.largestError(), 0.03) << "held, not moved to the board";
  EXPECT_GT(positionStddev(run.result()), 2.0 * stddev_before);
  EXPECT_LT(run.result().visible_fraction, 0.2);
  for (int k = 8; k >= 1; --k) run.step(restingPose(), Board{begin, begin + reach * k / 8, 0.55});
  run.rest(restingPose(), 8);
  EXPECT_EQ(run.result().state, TrackerState::kTracking);
  EXPECT_LT(run.lastError(), 0.004);
  EXPECT_LT(positionStddev(run.result()), 2.0 * stddev_before);
}

TEST_F(Motion, DropOutsDoNotMatter) {
  std::mt19937_64 engine(5);
  std::bernoulli_distribution drop(0.5);
  TrackingRun run(scene_, restingPose());
  run.rest(restingPose(), kSettleFrames);
  run.startJudging();
  Pose truth = restingPose();
  for (int k = 0; k < 24; ++k) {
    truth = movedBy(truth, 0.1 / 30.0, 0, 0);
    std::vector<std::uint16_t> image = scene_.render(truth);
    for (std::uint16_t& count : image) {
      if (drop(engine)) count = 0;
    }
    if (k % 4 == 3) std::fill(image.begin(), image.end(), std::uint16_t{0});
    run.stepWithImage(image, truth);
  }
  run.print("half of the readings, every fourth image empty");
  EXPECT_LT(run.medianError(), 0.006);
  EXPECT_LT(run.largestError(), 0.02);
  EXPECT_EQ(run.lostFrames(), 0);
}

TEST_F(Motion, AnObjectThatLeavesTheImageIsReportedLost) {
  Pose truth = restingPose();
  TrackingRun run(scene_, truth);
  run.rest(truth, kSettleFrames);
  for (int k = 0; k < 45; ++k) {
    truth = movedBy(truth, 0.75 / 30.0, 0, 0);
    run.step(truth);
    ASSERT_TRUE(run.result().T_camera_object.matrix().allFinite());
  }
  EXPECT_EQ(run.result().state, TrackerState::kLost);
  EXPECT_FALSE(run.result().reason.empty());
  EXPECT_EQ(run.result().score, 0.0);
}

TEST_F(Motion, AnObjectThatIsTakenAwayIsReportedLostAndFoundWhenPutBack) {
  TrackingRun run(scene_, restingPose());
  run.rest(restingPose(), kSettleFrames);
  for (int k = 0; k < 20; ++k) run.step(std::nullopt);
  EXPECT_EQ(run.result().state, TrackerState::kLost);
  EXPECT_FALSE(run.result().reason.empty());
  run.startJudging();
  run.rest(restingPose(), 25);
  EXPECT_EQ(run.result().state, TrackerState::kTracking);
  EXPECT_LT(run.lastError(), 0.006);
}

}  // namespace
}  // namespace depth_object_tracker
