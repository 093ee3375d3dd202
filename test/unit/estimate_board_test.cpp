// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/estimate_board.h"

#include "depth_object_tracker/geometry/shape_meshes.h"

#include <gtest/gtest.h>

#include <thread>

namespace depth_object_tracker {
namespace {

std::shared_ptr<const TriangleMesh> boxMesh() {
  return std::make_shared<const TriangleMesh>(makeBox(Eigen::Vector3d(0.1, 0.1, 0.1)));
}

PinholeCamera camera() {
  return {64, 48, 60.0, 60.0, 31.5, 23.5};
}

TrackerResult trackingAt(double x_m, double stamp_s = 10.0) {
  TrackerResult result;
  result.state = TrackerState::kTracking;
  result.has_pose = true;
  result.stamp_s = stamp_s;
  result.T_camera_object.translation() = Eigen::Vector3d(x_m, 0.0, 1.0);
  result.score = result.visible_fraction = 1.0;
  result.covariance = 1e-7 * Matrix6d::Identity();
  return result;
}

TEST(EstimateBoard, TellsTheOthersWithTheSameCamera) {
  EstimateBoard board;
  const auto a = board.join(), b = board.join(), elsewhere = board.join();
  board.tell(a, "left", trackingAt(0.1), boxMesh());
  EXPECT_TRUE(board.heardBy(a, "left").empty()) << "nobody hears itself";
  ASSERT_EQ(board.heardBy(b, "left").size(), 1u);
  EXPECT_TRUE(board.heardBy(elsewhere, "right").empty());
  board.leave(a);
  EXPECT_TRUE(board.heardBy(b, "left").empty());
}

TEST(EstimateBoard, SaysNothingOfWhatIsHiddenOrLost) {
  EstimateBoard board;
  const auto a = board.join(), b = board.join();
  for (const TrackerState state : {TrackerState::kOccluded, TrackerState::kLost, TrackerState::kInitializing}) {
    TrackerResult result = trackingAt(0.0);
    result.state = state;
    board.tell(a, "", result, boxMesh());
    EXPECT_TRUE(board.heardBy(b, "").empty()) << stateName(state);
  }
}

TEST(EstimateBoard, OfTwoThatHoldTheSameTheOlderTrackHasIt) {
  EstimateBoard board;
  const auto a = board.join(), b = board.join();
  board.tell(b, "", trackingAt(0.0), boxMesh());
  board.tell(a, "", trackingAt(0.0), boxMesh());
  EXPECT_TRUE(board.heardBy(a, "").front().is_seen) << "b was there first";
  EXPECT_FALSE(board.heardBy(b, "").front().is_seen);
  TrackerResult lost;
  lost.state = TrackerState::kLost;
  board.tell(b, "", lost, boxMesh());
  EXPECT_TRUE(board.heardBy(b, "").front().is_seen) << "who searches has nothing";
}

TEST(EstimateBoard, IsOnePerNameAndForgottenWithItsLastMember) {
  const auto board = EstimateBoard::forImages("/camera/depth");
  EXPECT_EQ(board, EstimateBoard::forImages("/camera/depth"));
  EXPECT_NE(board, EstimateBoard::forImages("/other/depth"));
  {
    const BoardMembership member(board);
    EXPECT_EQ(board->numMembers(), 1u);
  }
  EXPECT_EQ(board->numMembers(), 0u);
}

TEST(EstimateBoard, MayBeUsedByManyThreads) {
  const auto board = std::make_shared<EstimateBoard>();
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([board] {
      BoardMembership member(board);
      const auto mesh = boxMesh();
      for (int i = 0; i < 200; ++i) {
        member.tell("", trackingAt(0.001 * i), mesh);
        EXPECT_LE(member.hear("").size(), 3u);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(board->numMembers(), 0u);
}

TEST(OtherObjects, AreWhereTheyAreAtTheImagesTime) {
  ObjectEstimate estimate = *tellOthers(trackingAt(-0.2), boxMesh());
  estimate.twist[0] = 2.0;
  OtherObjects others;
  ASSERT_EQ(others.place({estimate}, 10.1), 1u);
  const std::vector<float>& depth = others.render(camera());
  EXPECT_NEAR(depth[23 * 64 + 32], 0.95f, 1e-3f) << "0.1 s at 2 m/s from 0.2 m to the left: in the middle";
  EXPECT_EQ(depth[23 * 64 + 2], 0.0f);
  EXPECT_EQ(others.renderSeen(camera()), depth);
  EXPECT_EQ(others.place({estimate}, 10.3), 0u) << "too old";
  EXPECT_EQ(others.place({estimate}, 9.0), 0u) << "time jumped back";
}

TEST(OtherObjects, DrawTheNearestAndKeepApartWhatIsSurelySeen) {
  TrackerResult unsure = trackingAt(0.0);
  unsure.T_camera_object.translation().z() = 0.8;
  unsure.score = 0.3;
  const auto mesh = boxMesh();
  OtherObjects others;
  EXPECT_EQ(others.place({*tellOthers(trackingAt(0.0), mesh), *tellOthers(unsure, mesh)}, 10.0), 2u);
  EXPECT_NEAR(others.render(camera())[23 * 64 + 32], 0.75f, 1e-3f);
  EXPECT_NEAR(others.renderSeen(camera())[23 * 64 + 32], 0.95f, 1e-3f);
}

}  // namespace
}  // namespace depth_object_tracker
