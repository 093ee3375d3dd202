// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/robot/kinematic_correction.h"

#include "random_pose.h"

#include <gtest/gtest.h>

namespace depth_object_tracker {
namespace {

// A hand that swings, kinematics whose error grows to 2 cm, an object that slips between 1 and 2 s.
class KinematicCorrectionTest : public testing::Test {
 protected:
  KinematicCorrectionTest()
      : engine_(7), T_camera_begin_(randomPose(engine_, 1.0)), T_link_object_(randomPose(engine_, 0.1)) {}

  static Pose error(double t_s) { return Pose(Eigen::Translation3d(0.0, 0.01 * t_s, 0.0)); }
  Pose T_camera_link(double t_s) const {
    return T_camera_begin_ * Eigen::AngleAxisd(0.5 * t_s, Eigen::Vector3d(1, 2, 0).normalized()) *
           Eigen::Translation3d(0.1, 0, 0.2);
  }
  Pose T_link_object(double t_s) const {
    const double slipped = std::min(std::max(t_s - 1.0, 0.0), 1.0);
    return T_link_object_ * Eigen::Translation3d(0.02 * slipped, 0.0, 0.0);
  }
  ObservedHand observe(double t_s, bool slipping) {
    const Pose T_camera_link_reported = T_camera_link(t_s) * error(t_s).inverse();
    return correction_.update(t_s, T_camera_link_reported, T_camera_link(t_s) * T_link_object(t_s), slipping);
  }

  std::mt19937_64 engine_;
  Pose T_camera_begin_, T_link_object_;
  KinematicCorrection correction_;
};

TEST_F(KinematicCorrectionTest, IsTheErrorOfTheKinematicsSinceTheGrasp) {
  EXPECT_LT(largestDifference(observe(0.0, false).T_link_observed, Pose::Identity()), 1e-12);
  const ObservedHand hand = observe(0.9, false);
  EXPECT_LT(largestDifference(hand.T_link_observed, error(0.9)), 1e-12);
  EXPECT_LT(largestDifference(hand.T_link_object, T_link_object_), 1e-12);
}

TEST_F(KinematicCorrectionTest, ASlipMovesTheObjectAndNotTheHand) {
  ObservedHand hand;
  for (double t_s = 0.0; t_s < 2.5; t_s += 1.0 / 30.0) hand = observe(t_s, t_s > 1.15 && t_s < 2.1);
  // Of the error of 2.5 cm, that of the second of slip went into the object; of the slip of 2 cm nearly nothing into
  // the hand.
  EXPECT_LT((hand.T_link_observed.translation() - Eigen::Vector3d(0.0, 0.014, 0.0)).norm(), 0.003);
  EXPECT_LT((hand.T_link_object.translation() - T_link_object(2.5).translation()).norm(), 0.014);
}

TEST_F(KinematicCorrectionTest, ANewGraspStartsAnew) {
  observe(0.0, false);
  observe(0.9, false);
  correction_.reset();
  EXPECT_LT(largestDifference(observe(1.0, false).T_link_observed, Pose::Identity()), 1e-12);
}

}  // namespace
}  // namespace depth_object_tracker
