// SPDX-License-Identifier: BSD-3-Clause
// Turns after which an object looks almost the same.
#include "depth_object_tracker/tracker/look_alikes.h"

#include "scripted_scene.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <limits>

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
