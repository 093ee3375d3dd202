// SPDX-License-Identifier: BSD-3-Clause
// Where a part of an object that is seen borders on one that is hidden, counted by hand.
#include "plate_scene.h"

#include "depth_object_tracker/filter/depth_likelihood.h"

#include <gtest/gtest.h>

namespace depth_object_tracker {
namespace {

constexpr double kFocalPx = 100.0, kPlateM = 1.0, kTurnRad = 0.6;
constexpr float kHalfWidthM = 0.15f;

/// A plate that is turned about its upright middle line: its left half lies farther away than its right one.
class HiddenEdges : public testing::Test {
 protected:
  HiddenEdges() : pose_(poseAt(0, 0, kPlateM)) { pose_.rotate(Eigen::AngleAxisd(kTurnRad, Eigen::Vector3d::UnitY())); }

  float plateDepth(int col) const {
    const Eigen::Vector3d ray = camera_.ray(col, 0), normal = pose_.linear().col(2);
    return static_cast<float>(normal.z() * kPlateM / normal.dot(Eigen::Vector3d(ray.x(), 0, 1)));
  }

  PoseAssessment assess(const std::vector<float>& depth_m) {
    DepthLikelihood likelihood(makePlate(kHalfWidthM), Eigen::Vector3d::Zero(), PixelModelConfig(),
                               OcclusionChainConfig(), 1, 1);
    likelihood.setImage(viewOf(depth_m, camera_), makeSamplingGrid(camera_, 1), 0.0);
    return likelihood.assessWithEdges(pose_, 0);
  }

  /// An image whose columns are `left` of the middle column and beyond it `right`.
  template <typename Left, typename Right>
  std::vector<float> image(const Left& left, const Right& right) const {
    std::vector<float> depth_m;
    for (int row = 0; row < camera_.height; ++row) {
      for (int col = 0; col < camera_.width; ++col) {
        depth_m.push_back(2 * col < camera_.width ? left(col) : right(col));
      }
    }
    return depth_m;
  }

  PinholeCamera camera_ = makeCamera(64, 64, kFocalPx);
  Pose pose_;
};

TEST_F(HiddenEdges, AreAsManyAsRowsWhereABoardHidesOneHalf) {
  const auto plate = [this](int col) { return plateDepth(col); };
  const auto board = [](int) { return 0.6f; };
  const PoseAssessment assessment = assess(image(board, plate));
  const double rows = 2.0 * kHalfWidthM * kFocalPx / kPlateM;
  EXPECT_NEAR(assessment.hidden_edges, rows, 2.0);
  EXPECT_EQ(assessment.merging_edges, 0);
}

TEST_F(HiddenEdges, AllMergeWhereOneWallIsTakenForTheSeenPartAndForWhatHidesTheRest) {
  const auto wall = [](int) { return static_cast<float>(kPlateM); };
  const PoseAssessment assessment = assess(image(wall, wall));
  EXPECT_GT(assessment.hidden_edges, 20);
  EXPECT_EQ(assessment.merging_edges, assessment.hidden_edges);
}

TEST_F(HiddenEdges, AreNoneWhereAllIsSeen) {
  const auto plate = [this](int col) { return plateDepth(col); };
  const PoseAssessment assessment = assess(image(plate, plate));
  EXPECT_GT(assessment.measured_pixels, 500);
  EXPECT_EQ(assessment.hidden_edges, 0);
}

}  // namespace
}  // namespace depth_object_tracker
