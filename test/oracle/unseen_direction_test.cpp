// SPDX-License-Identifier: BSD-3-Clause
// Directions that no image says anything about: few particles must stay as spread there as the process spreads them.
#include "depth_object_tracker/filter/particle_filter.h"
#include "depth_object_tracker/filter/transition_kernel.h"

#include "toy_likelihood.h"

#include <gtest/gtest.h>

#include <cmath>

namespace depth_object_tracker {
namespace {

constexpr double kFrameS = 1.0 / 30.0;
constexpr double kRadiusM = 0.05;

/// Three axes are measured to 0.5 mm, with ripples of one nat that no local model knows, so that weights are uneven;
/// the others are not seen at all.
ToyLikelihood roughToy() {
  constexpr double kStddevM = 0.5e-3, kRippleNat = 1.0, kWaveM = 0.2e-3;
  return {[=](const Vector6d& x) {
            double value = 0.0;
            for (int axis = 0; axis < 3; ++axis) {
              value += -0.5 * std::pow(x[axis] / kStddevM, 2) + kRippleNat * std::cos(2.0 * M_PI * x[axis] / kWaveM);
            }
            return value;
          },
          [=](const Vector6d& x) {
            Linearisation model;
            model.information.setZero();
            model.information.diagonal().head<3>().setConstant(1.0 / (kStddevM * kStddevM));
            model.gradient = -(model.information * x);
            return model;
          }};
}

TEST(UnseenDirections, KeepTheSpreadOfTheProcess) {
  constexpr int kFrames = 90, kSeeds = 24;
  const ProcessConfig process = randomWalk(0.02, 0.1);
  const ProcessStep step = stepOf(process, kFrameS);
  const Vector6d start = Vector6d::Constant(1e-8);
  double spread = 0.0, effective = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    FilterConfig config;
    config.num_particles = 70;
    config.seed = seed;
    ParticleFilter filter(config, kRadiusM, Symmetries());
    filter.initialise(Pose::Identity());
    FilterEstimate estimate;
    for (int k = 0; k <= kFrames; ++k) {
      ToyLikelihood likelihood = roughToy();
      estimate = filter.update(likelihood, k == 0 ? ProcessStep(process, start) : step, 1.0);
      effective += estimate.effective_sample_size / ((kFrames + 1) * kSeeds);
    }
    const double expected = kFrames * step.component(0).variances[3];
    for (int axis = 3; axis < 6; ++axis) spread += estimate.pose.covariance(axis, axis) / expected / (3 * kSeeds);
  }
  std::printf("effective samples %.0f of 70, spread after %d frames %.2f of the process's\n", effective, kFrames,
              spread);
  ASSERT_LT(effective, 40.0) << "else resampling takes nothing";
  EXPECT_GT(spread, 0.7);
  EXPECT_LT(spread, 1.4);
}

TEST(TransitionKernel, IsTheProcessWhereNothingWasLost) {
  ProcessConfig config = randomWalk(0.1, 2.5);
  config.sudden_motion_share = 0.1;
  config.sudden_motion_scale = 2.0;
  const ProcessStep step = stepOf(config, kFrameS);
  const TransitionKernel kernel(step);
  for (const double size : {0.0, 0.01, 0.1}) {
    const Vector6d displacement = size * (Vector6d() << 1.0, -2.0, 0.5, 3.0, -1.0, 2.0).finished();
    EXPECT_NEAR(kernel.logDensity(displacement), step.logDensity(displacement), 1e-9);
  }
}

TEST(TransitionKernel, IsWiderByWhatWasLost) {
  const ProcessStep step = stepOf(randomWalk(0.1, 0.5), kFrameS);
  Matrix6d lost = 1e-4 * Matrix6d::Identity();
  lost(0, 5) = lost(5, 0) = 5e-5;
  const TransitionKernel kernel(step, lost);
  const Matrix6d expected = Matrix6d(step.component(0).variances.asDiagonal()) + lost;
  EXPECT_LT((kernel.component(0).shape.covariance() - expected).norm(), 1e-12);
  EXPECT_LT((kernel.component(0).information * expected - Matrix6d::Identity()).norm(), 1e-9);
  EXPECT_NEAR(kernel.component(0).log_determinant, -std::log(expected.determinant()), 1e-9);
}

}  // namespace
}  // namespace depth_object_tracker
