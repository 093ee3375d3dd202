// SPDX-License-Identifier: BSD-3-Clause
// The pose process between two images: random motion, damped velocity, control of a held object.
#include "depth_object_tracker/model/process_model.h"

#include "random_pose.h"

#include <gtest/gtest.h>

#include <cmath>

namespace depth_object_tracker {
namespace {

const Eigen::Vector3d kCentre(0.08, -0.05, 0.1);

ProcessConfig paperProcess() {
  ProcessConfig config;
  config.velocity_half_life_s = 0.0;
  config.sudden_motion_share = 0.0;
  return config;
}

ProcessStep freeStep(const ProcessConfig& config, double dt_s) {
  return {config, dt_s, std::nullopt, kCentre, 1.0};
}

ControlInput heldWith(const Eigen::Vector3d& linear, const Eigen::Vector3d& angular) {
  ControlInput control;
  control.grasped = true;
  control.linear_m_s = linear;
  control.angular_rad_s = angular;
  return control;
}

Pose atCentre(const Pose& T_camera_object) {
  return T_camera_object * Eigen::Translation3d(kCentre);
}

TEST(ProcessStep, NoiseGrowsWithTheSquareRootOfTime) {
  const ProcessConfig config = paperProcess();
  for (const double dt : {1.0 / 30.0, 0.1, 0.5}) {
    const ProcessStep step = freeStep(config, dt);
    ASSERT_EQ(step.numComponents(), 1);
    for (int axis = 0; axis < 6; ++axis) {
      const double stddev = axis < 3 ? config.position_noise_m_per_sqrt_s : config.rotation_noise_rad_per_sqrt_s;
      EXPECT_NEAR(step.component(0).variances[axis], stddev * stddev * dt, 1e-12);
    }
  }
  const ProcessStep held_back(config, 0.1, std::nullopt, kCentre, 0.5);
  EXPECT_NEAR(held_back.component(0).variances[0], 0.25 * freeStep(config, 0.1).component(0).variances[0], 1e-12);
}

TEST(ProcessStep, WithoutVelocityAndControlThePoseIsExpectedToStay) {
  std::mt19937_64 engine(1);
  const Pose pose = randomPose(engine, 1.0);
  EXPECT_LT(largestDifference(freeStep(paperProcess(), 0.1).predict(pose, Vector6d::Ones()), pose), 1e-14);
  EXPECT_EQ(freeStep(paperProcess(), 0.1).dampedVelocity(Vector6d::Ones()).norm(), 0.0);
}

TEST(ProcessStep, VelocityHalvesInItsHalfLifeInAnySteps) {
  ProcessConfig config;
  config.velocity_half_life_s = 0.2;
  Vector6d velocity;
  velocity << 0.3, -0.2, 0.1, 1.0, 0.0, 0.0;
  EXPECT_LT((freeStep(config, 0.2).dampedVelocity(velocity) - 0.5 * velocity).norm(), 1e-12);
  Pose in_steps = Pose::Identity();
  Vector6d left = velocity;
  for (int k = 0; k < 10; ++k) {
    const ProcessStep step = freeStep(config, 0.02);
    in_steps = step.predict(in_steps, left);
    left = step.dampedVelocity(left);
  }
  EXPECT_LT(largestDifference(in_steps, freeStep(config, 0.2).predict(Pose::Identity(), velocity)), 1e-12);
  EXPECT_LT((left - 0.5 * velocity).norm(), 1e-12);
  const Pose soon = freeStep(config, 1e-3).predict(Pose::Identity(), velocity);
  EXPECT_LT((difference(soon, Pose::Identity()) / 1e-3 - velocity).norm(), 0.01);
}

TEST(ProcessStep, GapsClampTheNoiseAndStopTheMotion) {
  const ProcessConfig config;
  const ProcessStep at_limit = freeStep(config, config.max_gap_s), beyond = freeStep(config, 7.0 * config.max_gap_s);
  EXPECT_LT((at_limit.component(0).variances - beyond.component(0).variances).norm(), 1e-15);
  EXPECT_LT(largestDifference(beyond.predict(Pose::Identity(), Vector6d::Ones()), Pose::Identity()), 1e-12)
      << "a velocity of before the gap says nothing about the time after it";
  EXPECT_EQ(beyond.dampedVelocity(Vector6d::Ones()).norm(), 0.0);
}

TEST(ProcessStep, ControlMovesTheMeshOriginAndTurnsTheObjectAboutIt) {
  std::mt19937_64 engine(2);
  const Eigen::Vector3d linear(0.2, -0.1, 0.05), angular(0.5, -0.8, 0.3);
  for (int k = 0; k < 10; ++k) {
    const Pose T_camera_object = randomPose(engine, 1.0);
    const double dt = 1e-3;
    const ProcessStep step(ProcessConfig(), dt, heldWith(linear, angular), kCentre, 1.0);
    const Pose predicted = step.predict(atCentre(T_camera_object), Vector6d::Zero()) * Eigen::Translation3d(-kCentre);
    const Pose expected = perturb(T_camera_object, (Vector6d() << linear * dt, angular * dt).finished());
    EXPECT_LT(largestDifference(predicted, expected), 1e-12);
  }
}

TEST(ProcessStep, AnObjectMayMoveInTheHandThatIsFollowed) {
  ProcessConfig config;
  config.grasped_velocity_half_life_s = 0.1;
  const ProcessStep step(config, 0.1, heldWith({0.1, 0, 0}, {0, 0, 0.4}), kCentre, 1.0);
  const Vector6d velocity = (Vector6d() << 0, 0.2, 0, 0, 0, 0).finished();
  const Vector6d slipped =
      difference(step.predict(Pose::Identity(), velocity), step.predict(Pose::Identity(), Vector6d::Zero()));
  EXPECT_NEAR(slipped[1], 0.2 * 0.1 * 0.5 / M_LN2, 1e-12);  // integral of the damped velocity
  EXPECT_LT((step.dampedVelocity(velocity) - 0.5 * velocity).norm(), 1e-12);
  config.grasped_velocity_half_life_s = 0.0;
  const ProcessStep paper(config, 0.1, heldWith({0.1, 0, 0}, {0, 0, 0.4}), kCentre, 1.0);
  EXPECT_LT(
      largestDifference(paper.predict(Pose::Identity(), velocity), paper.predict(Pose::Identity(), Vector6d::Zero())),
      1e-15);
}

TEST(ProcessStep, ASlipWidensTheNoiseInTheHand) {
  const ProcessConfig config = paperProcess();
  const ControlInput control = heldWith({0.1, 0, 0}, {0, 0, 0});
  const ProcessStep held(config, 0.1, control, kCentre, 1.0), slips(config, 0.1, control, kCentre, 1.0, 3.0);
  EXPECT_LT((slips.component(0).variances - 9.0 * held.component(0).variances).norm(), 1e-12);
  const ProcessStep free(config, 0.1, std::nullopt, kCentre, 1.0, 3.0);
  EXPECT_EQ(free.component(0).variances, freeStep(config, 0.1).component(0).variances);
}

TEST(ProcessStep, TheControlCarriesTheObjectOverAGapOfAnyLength) {
  const ProcessConfig config;
  const double gap_s = 3.0 * config.max_gap_s;
  const ProcessStep step(config, gap_s, heldWith({0.1, 0, 0}, {0, 0, 0}), kCentre, 1.0);
  EXPECT_NEAR(step.predict(Pose::Identity(), Vector6d::Zero()).translation().x(), 0.1 * gap_s, 1e-12);
}

TEST(ProcessStep, ControlIsFollowedWithItsOwnNoiseAndBias) {
  const ProcessConfig config = paperProcess();
  for (const double dt : {1.0 / 30.0, 0.3}) {
    const ProcessStep step(config, dt, heldWith({0.1, 0, 0}, {0, 0, 0}), kCentre, 1.0);
    const double position = std::pow(config.grasped_position_noise_m_per_sqrt_s, 2) * dt +
                            std::pow(config.grasped_position_bias_m_per_s * dt, 2);
    const double rotation = std::pow(config.grasped_rotation_noise_rad_per_sqrt_s, 2) * dt +
                            std::pow(config.grasped_rotation_bias_rad_per_s * dt, 2);
    EXPECT_NEAR(step.component(0).variances[1], position, 1e-12);
    EXPECT_NEAR(step.component(0).variances[4], rotation, 1e-12);
    EXPECT_LT(position, 0.5 * freeStep(config, dt).component(0).variances[1]);
  }
}

TEST(ProcessStep, ControlThatIsNotHeldOrUnknownIsNotFollowed) {
  ControlInput not_held = heldWith({5, 5, 5}, {1, 1, 1}), unknown = not_held;
  not_held.grasped = false;
  unknown.has_twist = false;
  const ProcessConfig config = paperProcess();
  for (const ControlInput& control : {not_held, unknown}) {
    const ProcessStep step(config, 0.1, control, kCentre, 1.0);
    EXPECT_LT(largestDifference(step.predict(Pose::Identity(), Vector6d::Zero()), Pose::Identity()), 1e-14);
    EXPECT_GE(step.component(0).variances[0], freeStep(config, 0.1).component(0).variances[0])
        << "the noise must be wide";
  }
}

TEST(ProcessStep, SuddenMotionIsARareWideGaussian) {
  ProcessConfig config = paperProcess();
  config.sudden_motion_share = 0.02;
  config.sudden_motion_scale = 6.0;
  const ProcessStep step = freeStep(config, 0.1), narrow = freeStep(paperProcess(), 0.1);
  ASSERT_EQ(step.numComponents(), 2);
  EXPECT_NEAR(step.component(0).weight + step.component(1).weight, 1.0, 1e-15);
  EXPECT_LT((step.component(1).variances - 36.0 * narrow.component(0).variances).norm(), 1e-12);
  Vector6d displacement = Vector6d::Zero();
  for (const double x : {0.0, 0.02, 0.05, 0.2}) {
    displacement[0] = x;
    const double expected = std::log(0.98 * std::exp(step.component(0).logDensity(displacement)) +
                                     0.02 * std::exp(step.component(1).logDensity(displacement)));
    EXPECT_NEAR(step.logDensity(displacement), expected, 1e-9);
  }
  displacement[0] = 1e3;
  EXPECT_TRUE(std::isfinite(step.logDensity(displacement)));
}

TEST(ProcessStep, DensityIntegratesToOneAlongEachAxis) {
  const ProcessStep step = freeStep(ProcessConfig(), 1.0 / 30.0);
  for (int axis = 0; axis < 6; ++axis) {
    // Along one axis through the mode the density is the other five axes' peak times that axis' own marginal,
    // component-wise.
    for (int k = 0; k < step.numComponents(); ++k) {
      const ProcessComponent& component = step.component(k);
      const double stddev = std::sqrt(component.variances[axis]);
      double others = 0.0, sum = 0.0;
      for (int other = 0; other < 6; ++other) {
        if (other != axis) others -= 0.5 * std::log(2.0 * M_PI * component.variances[other]);
      }
      for (double t = -8.0; t < 8.0; t += 0.01) {
        const Vector6d displacement = (t + 0.005) * stddev * Vector6d::Unit(axis);
        sum += std::exp(component.logDensity(displacement) - others) * 0.01 * stddev;
      }
      EXPECT_NEAR(sum, 1.0, 1e-6);
    }
  }
}

TEST(ProcessStep, TinyTimeStepsKeepDensitiesFinite) {
  for (const double dt : {0.0, 1e-9, 1e-6}) {
    const ProcessStep step = freeStep(ProcessConfig(), dt);
    EXPECT_TRUE(std::isfinite(step.logDensity(Vector6d::Constant(0.01))));
    EXPECT_TRUE(step.predict(Pose::Identity(), Vector6d::Ones()).matrix().allFinite());
  }
}

TEST(ProcessStep, FirstStepBringsTheInitialUncertaintyAndNoMotion) {
  const Vector6d variances = (Vector6d() << 1e-4, 2e-4, 3e-4, 0.01, 0.02, 0.03).finished();
  const ProcessStep step(paperProcess(), variances);
  EXPECT_EQ(step.component(0).variances, variances);
  EXPECT_LT(largestDifference(step.predict(Pose::Identity(), Vector6d::Ones()), Pose::Identity()), 1e-14);
  EXPECT_EQ(step.dt(), 0.0);
}

}  // namespace
}  // namespace depth_object_tracker
