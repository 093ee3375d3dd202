// SPDX-License-Identifier: BSD-3-Clause
// Turns after which an object looks almost the same.
#include "depth_object_tracker/tracker/look_alike_check.h"

#include "scripted_scene.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

namespace depth_object_tracker {
namespace {

double angleBetween(const Pose& a, const Pose& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

LookAlikes lookAlikesOf(const ScriptedScene& scene, const Symmetries& symmetries = {}) {
  const TriangleMesh& mesh = scene.object().mesh;
  return findLookAlikes(mesh, surfaceCentroid(mesh), symmetries);
}

TEST(LookAlikesOfObjects, AMugLooksAlikeAllTheWayAboutItsAxis) {
  const ScriptedScene scene("mug", 1);
  const LookAlikes found = lookAlikesOf(scene);
  const auto about_axis = std::count_if(found.far.begin(), found.far.end(), [](const Pose& T) {
    return std::abs(Eigen::AngleAxisd(T.linear()).axis().z()) > 0.98;
  });
  EXPECT_GE(about_axis, 8);
  ASSERT_EQ(found.axes.size(), 1u);
  EXPECT_GT(std::abs(found.axes.front().direction.z()), 0.98);
}

TEST(LookAlikesOfObjects, ABoxEndForEndUnlessThatIsDeclared) {
  const ScriptedScene scene("box", 1);
  const LookAlikes undeclared = lookAlikesOf(scene);
  EXPECT_EQ(undeclared.far.size(), 3u);
  EXPECT_TRUE(undeclared.axes.empty()) << "a box does not turn freely";
  Symmetries symmetries;
  for (int axis = 0; axis < 3; ++axis) {
    Pose half_turn = Pose::Identity();
    half_turn.linear() = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::Unit(axis)).toRotationMatrix();
    symmetries.discrete.push_back(half_turn);
  }
  EXPECT_TRUE(lookAlikesOf(scene, symmetries).far.empty());
}

TEST(LookAlikesOfObjects, ADrillHasNoAxis) {
  const LookAlikes found = lookAlikesOf(ScriptedScene("drill", 1));
  EXPECT_LE(found.far.size(), 2u);
  EXPECT_TRUE(found.axes.empty());
}

class LookAlikeChecked : public testing::Test {
 protected:
  LookAlikeChecked()
      : scene_("mug", 3),
        centre_(surfaceCentroid(scene_.object().mesh)),
        likelihood_(scene_.object().mesh, centre_, PixelModelConfig(), OcclusionChainConfig(), 1, 1),
        check_(lookAlikesOf(scene_)) {
    // The handle is seen from the side.
    truth_ = restingPose() * Eigen::AngleAxisd(0.6, Eigen::Vector3d::UnitZ());
    likelihood_.setImage(scene_.view(scene_.render(truth_)), makeSamplingGrid(scene_.camera(), 2), 0.0);
    centre_truth_ = truth_ * Eigen::Translation3d(centre_);
    likelihood_.prepare({centre_truth_, turned(M_PI)});
  }

  /// The truth, turned about the mug's axis.
  Pose turned(double angle_rad) const {
    return truth_ * Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()) * Eigen::Translation3d(centre_);
  }

  /// Where some images lead to; none: they leave the pose where it is.
  std::optional<Pose> findBetter(const Pose& from, const TurnPrior& prior) {
    std::optional<Pose> best;
    for (int k = 0; k < 8; ++k) {
      if (auto better = check_.findBetter(likelihood_, best.value_or(from), kExponent, prior, 1.0 / 30.0))
        best = better;
    }
    return best;
  }

  static constexpr double kExponent = 0.06;
  static constexpr double kAnyTurn = std::numeric_limits<double>::infinity();
  ScriptedScene scene_;
  Eigen::Vector3d centre_;
  DepthLikelihood likelihood_;
  LookAlikeCheck check_;
  Pose truth_, centre_truth_;
};

TEST_F(LookAlikeChecked, AWrongTurnIsFoundOutWhenTheHandleIsSeen) {
  for (const double wrong : {0.25, 1.0, 2.0, 3.0}) {
    const std::optional<Pose> better = findBetter(turned(wrong), TurnPrior{false, kAnyTurn});
    ASSERT_TRUE(better) << wrong;
    EXPECT_LT(angleBetween(*better, centre_truth_), 0.12) << wrong;
  }
}

TEST_F(LookAlikeChecked, ATurnThatIsExpectedNeedsLessEvidence) {
  constexpr double kHandle = 3.0;
  EXPECT_TRUE(findBetter(turned(kHandle), TurnPrior{false, 0.5}));
  EXPECT_FALSE(findBetter(turned(kHandle), TurnPrior{false, 0.05}));
}

TEST_F(LookAlikeChecked, TheRightTurnIsKept) {
  for (int k = 0; k < 12; ++k) {
    EXPECT_FALSE(check_.findBetter(likelihood_, centre_truth_, kExponent, TurnPrior{k % 2 == 0, kAnyTurn}, 1.0 / 30.0));
  }
}

TEST_F(LookAlikeChecked, AFingerThatGoesOnBeyondTheHandleIsNone) {
  // The handle is behind the mug; beside the mug is something as deep as the handle would be, but broader.
  double hidden_rad = 0.0, beside_rad = 0.0;
  int fewest = std::numeric_limits<int>::max(), most = 0;
  for (double angle = 0.0; angle < 2.0 * M_PI; angle += 0.1) {
    const int covered = likelihood_.assess(turned(angle), 0).covered_pixels;
    if (covered < fewest) hidden_rad = angle;
    if (covered > most) beside_rad = angle;
    fewest = std::min(fewest, covered);
    most = std::max(most, covered);
  }
  constexpr int kBroaderPx = 8, kGapPx = 5, kWallMm = 200;
  const std::vector<std::uint16_t> beside =
      scene_.render(truth_ * Eigen::AngleAxisd(beside_rad, Eigen::Vector3d::UnitZ()));
  std::vector<std::uint16_t> image = scene_.render(truth_ * Eigen::AngleAxisd(hidden_rad, Eigen::Vector3d::UnitZ()));
  const std::vector<std::uint16_t> without = image;
  const int width = scene_.camera().width, height = scene_.camera().height;
  const auto at = [width](int row, int col) { return static_cast<std::size_t>(row * width + col); };
  const std::uint16_t wall = *std::max_element(without.begin(), without.end());
  const auto isMug = [&](int row, int col) {
    const bool is_inside = row >= 0 && col >= 0 && row < height && col < width;
    return is_inside && without[at(row, col)] > 0 && without[at(row, col)] < wall - kWallMm;
  };
  const auto isBesideMug = [&](int row, int col) {
    return !isMug(row, col - kGapPx) && !isMug(row, col + kGapPx) && !isMug(row - kGapPx, col) &&
           !isMug(row + kGapPx, col);
  };
  for (int row = kBroaderPx; row < height - kBroaderPx; ++row) {
    for (int col = kBroaderPx; col < width - kBroaderPx; ++col) {
      const std::uint16_t handle = beside[at(row, col)];
      if (handle == 0 || handle > wall - kWallMm || isMug(row, col)) continue;
      for (int r = row - kBroaderPx; r <= row + kBroaderPx; ++r) {
        for (int c = col - kBroaderPx; c <= col + kBroaderPx; ++c) {
          const bool is_own = r == row && c == col;
          if ((is_own || image[at(r, c)] == without[at(r, c)]) && isBesideMug(r, c)) image[at(r, c)] = handle;
        }
      }
    }
  }
  likelihood_.setImage(scene_.view(image), makeSamplingGrid(scene_.camera(), 2), 1.0 / 30.0);
  const Pose behind = turned(hidden_rad), as_handle = turned(beside_rad);
  likelihood_.prepare({as_handle, behind});
  constexpr double kEnoughNat = 9.0;
  ASSERT_GT(kExponent * (likelihood_.logLikelihood(as_handle, 0) - likelihood_.logLikelihood(behind, 0)), kEnoughNat)
      << "pixel by pixel the finger is the better handle";
  EXPECT_FALSE(findBetter(behind, TurnPrior{false, kAnyTurn}));
}

TEST_F(LookAlikeChecked, WhatLookedBetterWhenItCouldNotBeIsNoReasonLater) {
  // A finger where the handle could be, for all that the estimate knows.
  const Pose estimate = turned(2.5);
  likelihood_.prepare({centre_truth_, estimate});
  constexpr double kFingerNat = 14.0;
  const double exponent =
      kFingerNat / (likelihood_.logLikelihood(centre_truth_, 0) - likelihood_.logLikelihood(estimate, 0));
  ASSERT_GT(exponent, 0.0);
  const auto see = [&](double stddev_rad, int images) {
    for (int k = 0; k < images; ++k) {
      if (check_.findBetter(likelihood_, estimate, exponent, TurnPrior{true, stddev_rad}, 1.0 / 30.0)) return true;
    }
    return false;
  };
  constexpr double kSure = 0.3, kUnsure = 2.0;
  EXPECT_TRUE(see(kUnsure, 12)) << "new evidence counts";
  check_.restart();
  EXPECT_FALSE(see(kSure, 90));
  EXPECT_FALSE(see(kUnsure, 60)) << "it was there before";
  check_.restart();
  EXPECT_TRUE(see(kUnsure, 12));
}

}  // namespace
}  // namespace depth_object_tracker
