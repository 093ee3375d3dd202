// SPDX-License-Identifier: BSD-3-Clause
// Motion of an object in the hand that holds it.
#include "depth_object_tracker/model/slip_estimator.h"

#include "random_pose.h"

#include <gtest/gtest.h>

namespace depth_object_tracker {
namespace {

constexpr double kFrameS = 1.0 / 30.0;
constexpr double kPositionStddevM = 0.0004;
constexpr double kRotationStddevRad = 0.004;

/// Poses with independent errors, of an object that moves in the hand at a constant twist (object axes).
class NoisyHand {
 public:
  explicit NoisyHand(unsigned seed) : engine_(seed), R_camera_object_(randomRotation(engine_)) {}

  HandStep step(const Vector6d& twist_object) {
    Vector6d twist, error;
    twist << R_camera_object_ * twist_object.head<3>(), R_camera_object_ * twist_object.tail<3>();
    std::normal_distribution<double> normal;
    for (int k = 0; k < 6; ++k) error[k] = (k < 3 ? kPositionStddevM : kRotationStddevRad) * normal(engine_);
    HandStep step;
    step.residual = twist * kFrameS + error - last_error_;
    step.pose_variances << Eigen::Vector3d::Constant(kPositionStddevM * kPositionStddevM),
        Eigen::Vector3d::Constant(kRotationStddevRad * kRotationStddevRad);
    step.R_camera_object = R_camera_object_;
    step.dt_s = kFrameS;
    last_error_ = error;
    return step;
  }
  Vector6d inCamera(const Vector6d& twist_object) const {
    Vector6d twist;
    twist << R_camera_object_ * twist_object.head<3>(), R_camera_object_ * twist_object.tail<3>();
    return twist;
  }

 private:
  std::mt19937_64 engine_;
  Eigen::Matrix3d R_camera_object_;
  Vector6d last_error_ = Vector6d::Zero();
};

TEST(SlipEstimator, AFirmGraspIsNoSlip) {
  int alarms = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    NoisyHand hand(seed);
    SlipEstimator estimator{SlipConfig()};
    for (int k = 0; k < 60; ++k) alarms += estimator.update(hand.step(Vector6d::Zero())).slipping ? 1 : 0;
    EXPECT_LT(estimator.noiseScale(), 2.0);
  }
  EXPECT_LT(alarms, 6);  // of 1200
}

TEST(SlipEstimator, FindsTheTwistOfASlipInCameraAxes) {
  const Vector6d twist_object = (Vector6d() << 0.03, 0.0, -0.02, 0.0, 0.4, 0.0).finished();
  for (unsigned seed = 0; seed < 20; ++seed) {
    NoisyHand hand(seed);
    SlipEstimator estimator{SlipConfig()};
    SlipEstimate estimate;
    for (int k = 0; k < 15; ++k) estimate = estimator.update(hand.step(Vector6d::Zero()));
    for (int k = 0; k < 12; ++k) estimate = estimator.update(hand.step(twist_object));
    EXPECT_TRUE(estimate.slipping) << "after 0.4 s, seed " << seed << ": " << estimate.statistic;
    EXPECT_GT(estimator.noiseScale(), 2.0);
    EXPECT_LT((estimate.relative_twist - hand.inCamera(twist_object)).head<3>().norm(), 0.025);
    EXPECT_LT((estimate.relative_twist - hand.inCamera(twist_object)).tail<3>().norm(), 0.25);
    EXPECT_GT(estimate.covariance.ldlt().vectorD().minCoeff(), 0.0);
    for (int k = 0; k < 45; ++k) estimate = estimator.update(hand.step(Vector6d::Zero()));
    EXPECT_FALSE(estimate.slipping) << "1.5 s later";
  }
}

TEST(SlipEstimator, AFastHandMayBeWrongByMore) {
  const Vector6d error_object = (Vector6d() << 0.06, 0, 0, 0, 0, 0).finished();
  for (const bool is_fast : {false, true}) {
    NoisyHand hand(3);
    SlipEstimator estimator{SlipConfig()};
    SlipEstimate estimate;
    for (int k = 0; k < 30; ++k) {
      HandStep step = hand.step(error_object);
      if (is_fast) step.hand_velocity[0] = 1.5;
      estimate = estimator.update(step);
    }
    EXPECT_EQ(estimate.slipping, !is_fast) << estimate.statistic;
  }
}

// The arm yields to somebody's push: its hand moves and turns little, about joints far away.
TEST(SlipEstimator, APushedArmIsNoSlipButTheKinematicsAreTrustedLess) {
  const Vector6d push_object = (Vector6d() << 0.03, -0.02, 0.015, 0.0, 0.02, 0.015).finished();
  int pushed_alarms = 0, stiff_alarms = 0;  // of 400
  for (unsigned seed = 0; seed < 20; ++seed) {
    SlipConfig somebody_pushes;
    somebody_pushes.pushed_arm_error_m_per_s = 0.025;
    somebody_pushes.slip_threshold = 5.0;
    SlipEstimator estimator(somebody_pushes), stiff{SlipConfig()};
    NoisyHand hand(seed);
    for (int k = 0; k < 20; ++k) {
      const HandStep step = hand.step(push_object);
      pushed_alarms += estimator.update(step).slipping ? 1 : 0;
      stiff_alarms += stiff.update(step).slipping ? 1 : 0;
    }
    EXPECT_EQ(estimator.noiseScale(), stiff.noiseScale());
    EXPECT_GT(estimator.noiseScale(), 2.0);
  }
  EXPECT_LT(pushed_alarms, 20);
  EXPECT_GT(stiff_alarms, 200);
}

TEST(SlipEstimator, WhatIsNotSeenIsNoSlip) {
  NoisyHand hand(5);
  SlipEstimator estimator{SlipConfig()};
  SlipEstimate estimate;
  for (int k = 0; k < 30; ++k) {
    HandStep step = hand.step((Vector6d() << 0.03, 0, 0, 0, 0.4, 0).finished());
    step.pose_variances *= 1e6;
    estimate = estimator.update(step);
  }
  EXPECT_FALSE(estimate.slipping) << estimate.statistic;
}

TEST(SlipEstimator, ANewGraspStartsAnew) {
  NoisyHand hand(5);
  SlipEstimator estimator{SlipConfig()};
  for (int k = 0; k < 30; ++k) estimator.update(hand.step((Vector6d() << 0.05, 0, 0, 0, 0.5, 0).finished()));
  EXPECT_GT(estimator.noiseScale(), 1.0);
  estimator.reset();
  EXPECT_EQ(estimator.noiseScale(), 1.0);
  EXPECT_FALSE(estimator.update(hand.step(Vector6d::Zero())).slipping);
}

}  // namespace
}  // namespace depth_object_tracker
