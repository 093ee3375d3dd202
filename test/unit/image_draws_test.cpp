// SPDX-License-Identifier: BSD-3-Clause
// Poses drawn from an image's points: the object's own is among them, and all are reproducible.
#include "depth_object_tracker/tracker/image_draws.h"

#include "brick_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace depth_object_tracker {
namespace {

class BrickDraws : public ::testing::Test {
 protected:
  static constexpr std::uint64_t kSeed = 5;
  static constexpr int kStepPx = 4;

  BrickDraws() : camera_{640, 480, 570.0, 570.0, 319.5, 239.5}, draws_(draws(1)) {
    draws_->setPoints(movedBy(somewhere(), brickPoints()), camera_, kStepPx);
  }

  static std::unique_ptr<ImageDraws> draws(int num_threads) {
    return std::make_unique<ImageDraws>(brickPoints(), kBrickDiameterM, kSeed,
                                        std::make_shared<WorkerPool>(num_threads));
  }

  static bool isNear(const Pose& pose) {
    constexpr double kNearM = 0.03, kNearRad = 0.3;
    const Vector6d off = difference(pose, somewhere());
    return off.head<3>().norm() < kNearM && off.tail<3>().norm() < kNearRad;
  }

  PinholeCamera camera_;
  std::unique_ptr<ImageDraws> draws_;
};

TEST_F(BrickDraws, NothingIsDrawnWithoutPoints) {
  EXPECT_TRUE(draws_->canDraw());
  draws_->setPoints({}, camera_, kStepPx);
  EXPECT_FALSE(draws_->canDraw());
}

TEST_F(BrickDraws, VotesMeetThePoseFromMostReferences) {
  constexpr int kReferences = 30;
  int met = 0;
  for (int k = 0; k < kReferences; ++k) {
    const std::vector<Pose> poses = draws_->drawVotes(static_cast<std::uint64_t>(k), 1);
    met += std::any_of(poses.begin(), poses.end(), isNear) ? 1 : 0;
  }
  EXPECT_GT(met, kReferences / 2);
}

TEST_F(BrickDraws, PairsMeetThePoseMuchMoreOftenThanChance) {
  constexpr int kDraws = 5000;
  int met = 0;
  for (int k = 0; k < kDraws; ++k) met += isNear(draws_->draw(static_cast<std::uint64_t>(k))) ? 1 : 0;
  // By chance, with the position right: the share of rotations within 0.3 rad, 0.0014.
  EXPECT_GT(met, kDraws / 100);
}

TEST_F(BrickDraws, VotesDependOnTheNumberAloneNotOnThreads) {
  const auto two = draws(2);
  two->setPoints(movedBy(somewhere(), brickPoints()), camera_, kStepPx);
  const std::vector<Pose> alone = draws_->drawVotes(7, 16), together = two->drawVotes(7, 16);
  ASSERT_EQ(alone.size(), together.size());
  ASSERT_FALSE(alone.empty());
  for (std::size_t i = 0; i < alone.size(); ++i) EXPECT_EQ(alone[i].matrix(), together[i].matrix());
  const std::vector<Pose> again = draws_->drawVotes(7, 16);
  ASSERT_EQ(again.size(), alone.size());
  EXPECT_EQ(again.front().matrix(), alone.front().matrix());
}

TEST_F(BrickDraws, PointsOutsideOfTheImageAreNobodysNeighbours) {
  Pose aside = somewhere();
  aside.translation().x() += 2.0;
  draws_->setPoints(movedBy(aside, brickPoints()), camera_, kStepPx);
  const std::vector<Pose> poses = draws_->drawVotes(0, 10);
  EXPECT_TRUE(poses.empty());
  for (std::uint64_t k = 0; k < 200; ++k) EXPECT_TRUE(draws_->draw(k).matrix().allFinite());
}

}  // namespace
}  // namespace depth_object_tracker
