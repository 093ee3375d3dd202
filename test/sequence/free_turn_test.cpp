// SPDX-License-Identifier: BSD-3-Clause
// A mug whose handle is hidden may have turned about its axis: the estimate must say so, and no more than so.
#include "depth_object_tracker/tracker/free_turn.h"

#include "scripted_scene.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <limits>

namespace depth_object_tracker {
namespace {

constexpr double kExponent = 0.06, kFrameS = 1.0 / 30.0;
constexpr double kHandleBehind = 0.6 + M_PI, kHandleBeside = 0.6;

class FreeTurnOfAMug : public testing::Test {
 protected:
  FreeTurnOfAMug()
      : scene_("mug", 3),
        centre_(surfaceCentroid(scene_.object().mesh)),
        likelihood_(scene_.object().mesh, centre_, PixelModelConfig(), OcclusionChainConfig(), 1, 1),
        free_turn_({ScrewAxis{Eigen::Vector3d::UnitZ(), Eigen::Vector3d(-centre_.x(), -centre_.y(), 0.0)}}) {
    free_turn_.restart(0.02);
  }

  /// Of the centre. @param angle_rad of the mug about its axis.
  Pose at(double angle_rad) const {
    return restingPose() * Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()) * Eigen::Translation3d(centre_);
  }

  /// One image of the mug at an angle, about which the estimate is another.
  std::optional<Pose> see(double truth, double before, double estimate, const Eigen::Vector3d& angular_velocity) {
    const auto& image = scene_.render(restingPose() * Eigen::AngleAxisd(truth, Eigen::Vector3d::UnitZ()));
    likelihood_.setImage(scene_.view(image), makeSamplingGrid(scene_.camera(), 2), kFrameS);
    return free_turn_.update(likelihood_, at(before), at(estimate), kExponent, {1e-4, angular_velocity, kFrameS});
  }

  double stddevAbout(const Eigen::Vector3d& axis_in_object, double angle) const {
    const Matrix6d covariance = free_turn_.widened(1e-6 * Matrix6d::Identity(), at(angle));
    const Eigen::Vector3d axis = at(angle).linear() * axis_in_object;
    return std::sqrt(axis.dot(covariance.bottomRightCorner<3, 3>() * axis));
  }

  ScriptedScene scene_;
  Eigen::Vector3d centre_;
  DepthLikelihood likelihood_;
  FreeTurn free_turn_;
};

TEST_F(FreeTurnOfAMug, GrowsWhileTheHandleIsHidden) {
  for (int k = 0; k < 60; ++k) see(kHandleBehind, kHandleBehind, kHandleBehind, Eigen::Vector3d::Zero());
  EXPECT_TRUE(free_turn_.isFree());
  const double expected = std::sqrt(0.02 * 0.02 + 60 * 1e-4);
  EXPECT_NEAR(stddevAbout(Eigen::Vector3d::UnitZ(), kHandleBehind), expected, 0.1 * expected);
  EXPECT_NEAR(stddevAbout(Eigen::Vector3d::UnitX(), kHandleBehind), 1e-3, 1e-5) << "only about its axis";
}

TEST_F(FreeTurnOfAMug, GrowsFasterWhenTheMugIsTurned) {
  for (int k = 0; k < 15; ++k) see(kHandleBehind, kHandleBehind, kHandleBehind, Eigen::Vector3d::Zero());
  const double still = free_turn_.stddevRad();
  free_turn_.restart(0.02);
  const Eigen::Vector3d across = at(kHandleBehind).linear() * Eigen::Vector3d(2.0, 0.0, 0.0);
  for (int k = 0; k < 15; ++k) see(kHandleBehind, kHandleBehind, kHandleBehind, across);
  EXPECT_GT(free_turn_.stddevRad(), 2.0 * still);
}

TEST_F(FreeTurnOfAMug, IsBoundedByWhereTheHandleWouldBeSeen) {
  free_turn_.restart(std::numeric_limits<double>::infinity());
  see(kHandleBehind, kHandleBehind, kHandleBehind, Eigen::Vector3d::Zero());
  EXPECT_GT(free_turn_.stddevRad(), 0.2);
  EXPECT_LT(free_turn_.stddevRad(), 1.0);
}

TEST_F(FreeTurnOfAMug, EndsWhenTheHandleIsSeen) {
  free_turn_.restart(std::numeric_limits<double>::infinity());
  for (int k = 0; k < 30; ++k) {
    EXPECT_FALSE(see(kHandleBeside, kHandleBeside, kHandleBeside, Eigen::Vector3d::Zero()));
  }
  EXPECT_LT(free_turn_.stddevRad(), 0.1);
}

TEST_F(FreeTurnOfAMug, ATurnWithoutAReasonIsTakenBack) {
  // The cloud wandered by 0.1 rad in one image; the angle was known to 0.02.
  const std::optional<Pose> turn = see(kHandleBehind, kHandleBehind, kHandleBehind + 0.1, Eigen::Vector3d::Zero());
  ASSERT_TRUE(turn);
  const Eigen::Vector3d back = logSo3(turn->linear());
  EXPECT_NEAR(back.z(), -0.1, 0.02);
  EXPECT_LT(((at(kHandleBehind + 0.1) * *turn).translation() - at(kHandleBehind).translation()).norm(), 1e-3);
}

TEST_F(FreeTurnOfAMug, StaysWhereItShouldBeThoughTheMiddleIsElsewhere) {
  // The handle is behind the mug, nearer to where it would be seen on one side.
  const double angle = kHandleBehind + 0.35;
  free_turn_.restart(0.3);
  double estimate = angle;
  for (int k = 0; k < 60; ++k) {
    if (const auto turn = see(angle, estimate, estimate, Eigen::Vector3d::Zero()))
      estimate += logSo3(turn->linear()).z();
  }
  EXPECT_TRUE(free_turn_.isFree());
  EXPECT_NEAR(estimate, angle, 0.05);
}

TEST_F(FreeTurnOfAMug, GoesWhereTheHandleIsSeen) {
  // Behind the mug the handle contradicts nothing, but what shows beside the mug is then left unexplained.
  for (const double turned : {-1.4, -0.7, -0.5, 1.1, 1.4}) {
    const double angle = kHandleBehind + turned;
    free_turn_.restart(0.7);
    double estimate = kHandleBehind;
    for (int k = 0; k < 15; ++k) {
      if (const auto turn = see(angle, estimate, estimate, Eigen::Vector3d::Zero())) {
        estimate += logSo3(turn->linear()).z();
      }
    }
    EXPECT_NEAR(estimate, angle, 0.08) << turned;
  }
}

TEST_F(FreeTurnOfAMug, SpinsOnlyAsItWasSeenTo) {
  constexpr double kRate = 1.5;
  const auto spin = [&](double angle, double rate) -> Eigen::Vector3d {
    return at(angle).linear() * Eigen::Vector3d(0.3, 0.0, rate);
  };
  const auto shown_rate = [&](double angle) {
    Vector6d velocity = Vector6d::Zero();
    velocity.tail<3>() = spin(angle, 5.0);  // as particles have it
    const Eigen::Vector3d shown = at(angle).linear().transpose() * free_turn_.shownPart(velocity, at(angle)).tail<3>();
    EXPECT_NEAR(shown.x(), 0.3, 1e-9) << "about other axes as it is";
    return shown.z();
  };
  see(kHandleBeside, kHandleBeside, kHandleBeside, spin(kHandleBeside, kRate));
  EXPECT_NEAR(shown_rate(kHandleBeside), 5.0, 1e-9) << "seen: the particles are right";
  see(kHandleBehind, kHandleBehind, kHandleBehind, spin(kHandleBehind, 5.0));
  const double at_first = shown_rate(kHandleBehind);
  EXPECT_LT(at_first, kRate);
  EXPECT_GT(at_first, 0.5 * kRate);
  for (int k = 0; k < 30; ++k) see(kHandleBehind, kHandleBehind, kHandleBehind, spin(kHandleBehind, 5.0));
  EXPECT_LT(shown_rate(kHandleBehind), 0.1 * kRate);
}

TEST_F(FreeTurnOfAMug, ATurnToALookAlikeIsDoubtedForAWhile) {
  see(kHandleBeside, kHandleBeside, kHandleBeside, Eigen::Vector3d::Zero());
  Pose half_turn = Pose::Identity();
  half_turn.linear() = Eigen::AngleAxisd(1.5, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  free_turn_.turned(half_turn);
  const double at_first = stddevAbout(Eigen::Vector3d::UnitZ(), kHandleBeside);
  EXPECT_GT(at_first, 0.3);
  for (int k = 0; k < 90; ++k) see(kHandleBeside, kHandleBeside, kHandleBeside, Eigen::Vector3d::Zero());
  EXPECT_LT(stddevAbout(Eigen::Vector3d::UnitZ(), kHandleBeside), 0.5 * at_first);
}

TEST(ScrewAxes, AreFoundFromTheirTurns) {
  const ScrewAxis axis{Eigen::Vector3d(1.0, 2.0, -1.0).normalized(), Eigen::Vector3d(0.02, -0.01, 0.03)};
  for (const double angle : {0.2, 1.5, 3.0}) {
    const ScrewAxis found = axisOf(turnAbout(axis, angle));
    EXPECT_NEAR(found.direction.dot(axis.direction), 1.0, 1e-9);
    EXPECT_LT((found.point - axis.point).cross(axis.direction).norm(), 1e-9) << "on the line";
  }
}

TEST(ScrewAxes, AreCommonToAMugsTurnsButNotToABoxs) {
  const ScrewAxis axis{Eigen::Vector3d::UnitY(), Eigen::Vector3d(0.01, 0.0, 0.0)};
  std::vector<Pose> turns;
  for (const double angle : {0.5, 1.0, -1.5, 2.0, 3.0}) turns.push_back(turnAbout(axis, angle));
  ASSERT_EQ(commonAxes(turns).size(), 1u);
  EXPECT_GT(std::abs(commonAxes(turns).front().direction.y()), 0.999);
  std::vector<Pose> half_turns;
  for (int k = 0; k < 3; ++k)
    half_turns.push_back(turnAbout({Eigen::Vector3d::Unit(k), Eigen::Vector3d::Zero()}, M_PI));
  EXPECT_TRUE(commonAxes(half_turns).empty());
}

}  // namespace
}  // namespace depth_object_tracker
