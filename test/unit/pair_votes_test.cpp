// SPDX-License-Identifier: BSD-3-Clause
// Pairs of points vote for poses; what a search found is told from what fits by chance.
#include "depth_object_tracker/tracker/pair_votes.h"

#include "brick_points.h"
#include "tracker/pose_evidence.h"

#include "depth_object_tracker/filter/random.h"

#include <gtest/gtest.h>

namespace depth_object_tracker {
namespace {

class BrickVotes : public ::testing::Test {
 protected:
  BrickVotes() : points_(brickPoints()), pairs_(points_, kBrickDiameterM), votes_(pairs_) {}

  /// Lets every point of the brick at `T` but one vote about that one.
  std::vector<Pose> poses(const Pose& T, std::size_t reference, int count) {
    const std::vector<OrientedPoint> moved = movedBy(T, points_);
    votes_.start(moved[reference]);
    const CounterRandom random(3);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const auto number = [&](std::uint32_t k) { return random.uniform(RandomPurpose::kSearch, i, k); };
      if (i != reference) votes_.vote(moved[i], {number(0), number(1), number(2), number(3)}, number(4));
    }
    std::vector<Pose> result;
    votes_.bestPoses(count, result);
    return result;
  }

  std::vector<OrientedPoint> points_;
  PointPairs pairs_;
  PairVotes votes_;
};

TEST_F(BrickVotes, MeetThePoseFromAnyOfItsPoints) {
  const Pose truth = somewhere();
  int met = 0, asked = 0;
  for (std::size_t reference = 0; reference < points_.size(); reference += 7, ++asked) {
    double least_m = 1.0;
    for (const Pose& pose : poses(truth, reference, 5)) {
      const Vector6d off = difference(pose, truth);
      if (off.tail<3>().norm() < 0.3) least_m = std::min(least_m, off.head<3>().norm());
    }
    met += least_m < 0.03 ? 1 : 0;
  }
  EXPECT_GT(met, asked * 3 / 4) << "of " << asked;
}

TEST_F(BrickVotes, GiveNoMorePosesThanAskedFor) {
  EXPECT_EQ(poses(somewhere(), 10, 3).size(), 3u);
}

TEST_F(BrickVotes, ForgetWhatWasVotedBefore) {
  poses(somewhere(), 10, 5);
  votes_.start(points_[0]);
  std::vector<Pose> none;
  votes_.bestPoses(5, none);
  EXPECT_TRUE(none.empty());
}

PoseAssessment wellSeen() {
  PoseAssessment assessment;
  assessment.covered_pixels = 800;
  assessment.measured_pixels = 790;
  assessment.visible_pixels = 700.0;
  assessment.surrounding_pixels = 100;
  assessment.continued_pixels = 5;
  assessment.beyond_pixels = 70;
  assessment.expected = 4000.0;
  assessment.achieved = 3960.0;
  assessment.log_likelihood = 3600.0;
  return assessment;
}

TEST(FindLogOdds, FavourWhatIsWellSeen) {
  EXPECT_GT(findLogOdds(wellSeen(), 0.98), 2.0);
}

TEST(FindLogOdds, FallWithTheFitTheOutlineAndTheEvidence) {
  const double best = findLogOdds(wellSeen(), 0.98);
  PoseAssessment worse_fit = wellSeen();
  worse_fit.achieved *= 0.9;
  EXPECT_LT(findLogOdds(worse_fit, 0.98), best - 1.0);
  PoseAssessment part_of_a_wall = wellSeen();
  part_of_a_wall.continued_pixels = 40;
  EXPECT_LT(findLogOdds(part_of_a_wall, 0.98), best - 2.0);
  PoseAssessment little = wellSeen();
  little.visible_pixels *= 0.1;
  EXPECT_LT(findLogOdds(little, 0.98), best - 2.0);
}

TEST(FindLogOdds, RiseWhereTheOutlineIsSeenToEnd) {
  PoseAssessment nowhere_seen_to_end = wellSeen();
  nowhere_seen_to_end.beyond_pixels = 0;
  EXPECT_LT(findLogOdds(nowhere_seen_to_end, 0.98), findLogOdds(wellSeen(), 0.98) - 2.0);
}

TEST(FindLogOdds, FallWhereTheHiddenPartsWouldBeBehindTheSeenOnesSurface) {
  PoseAssessment beside_fingers = wellSeen();
  beside_fingers.hidden_edges = 60;
  beside_fingers.merging_edges = 20;
  EXPECT_EQ(findLogOdds(beside_fingers, 0.98), findLogOdds(wellSeen(), 0.98));
  PoseAssessment in_a_board = beside_fingers;
  in_a_board.merging_edges = 60;
  EXPECT_LT(findLogOdds(in_a_board, 0.98), findLogOdds(wellSeen(), 0.98) - 3.0);
}

TEST(FindLogOdds, DoNotBlameTheObjectForWhatHidesHalfOfIt) {
  PoseAssessment half_hidden = wellSeen();
  half_hidden.visible_pixels *= 0.5;
  half_hidden.achieved *= 0.5;
  half_hidden.expected *= 0.5;
  half_hidden.log_likelihood *= 0.5;
  EXPECT_NEAR(findLogOdds(half_hidden, 0.98), findLogOdds(wellSeen(), 0.98), 1e-9);
}

TEST(FindLogOdds, DoNotBlameTheObjectForItsMesh) {
  PoseAssessment bad_mesh = wellSeen();
  bad_mesh.achieved = 0.8 * bad_mesh.expected;
  EXPECT_NEAR(findLogOdds(bad_mesh, 0.8), findLogOdds(wellSeen(), 0.99), 1e-9);
}

TEST(FindLogOdds, AreNotRaisedByNearnessToTheCamera) {
  PoseAssessment near_camera = wellSeen();
  near_camera.covered_pixels *= 4;
  near_camera.measured_pixels *= 4;
  near_camera.visible_pixels *= 4.0;
  near_camera.log_likelihood *= 4.0;
  EXPECT_NEAR(findLogOdds(near_camera, 0.98), findLogOdds(wellSeen(), 0.98), 1e-9);
}

TEST(FindLogOdds, AreFiniteOrMinusInfiniteForNothing) {
  EXPECT_LT(findLogOdds(PoseAssessment(), 0.98), -1e9);
}

}  // namespace
}  // namespace depth_object_tracker
