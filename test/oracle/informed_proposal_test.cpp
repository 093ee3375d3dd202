// SPDX-License-Identifier: BSD-3-Clause
// The informed proposal draws from the density that it states.
#include "depth_object_tracker/filter/informed_proposal.h"
#include "depth_object_tracker/filter/random.h"

#include "toy_likelihood.h"

#include <gtest/gtest.h>

#include <cmath>

namespace depth_object_tracker {
namespace {

constexpr double kFrameS = 1.0 / 30.0;
constexpr double kStandardErrors = 5.0;

class InformedProposalDensity : public testing::Test {
 protected:
  InformedProposalDensity() : step_(wideWalk()) {
    for (const double side : {-1.0, 1.0}) {
      LocalMode mode;
      mode.pose = perturb(Pose::Identity(), (Vector6d() << 0.02 * side, 0.01, 0, 0.5 * side, 0.2, 0).finished());
      mode.information.diagonal() << 1e4, 1e3, 1e4, 2.0, 6.0, 4.0;
      mode.information(0, 4) = mode.information(4, 0) = 60.0;
      mode.slope << 10.0, 0.0, -20.0, 0.5 * side, 0.2, -0.4;
      mode.log_likelihood = -0.5 * side;
      modes_.push_back(mode);
    }
  }

  static ProcessStep wideWalk() {
    ProcessConfig config = randomWalk(0.1, 2.5);  // 18 mm and 0.46 rad a frame: charts differ
    config.sudden_motion_share = 0.1;
    config.sudden_motion_scale = 2.0;
    return stepOf(config, kFrameS);
  }

  Vector6d normal(int i) const { return random_.normal6(RandomPurpose::kProposal, 1, static_cast<std::uint32_t>(i)); }
  double uniform(int i) const { return random_.uniform(RandomPurpose::kComponent, 1, static_cast<std::uint32_t>(i)); }

  ProcessStep step_;
  std::vector<LocalMode> modes_;
  CounterRandom random_{5};
};

TEST_F(InformedProposalDensity, BelongsToTheSamples) {
  // E_q[g / q] = 1 for any normalised density g inside of q, only if q is the density of what is drawn.
  const InformedProposal proposal(step_, modes_);
  const Pose predicted = perturb(Pose::Identity(), (Vector6d() << 0.005, 0, 0.01, 0.2, -0.3, 0.1).finished());
  const InformedProposal::ForParticle informed(proposal, predicted);
  // About the middle of one component, narrower than it.
  const Pose reference = informed.sample(1e-3, Vector6d::Zero());
  Matrix6d precision = modes_.front().information;
  precision.diagonal() += step_.component(0).variances.cwiseInverse();
  const Matrix6d covariance = 0.6 * precision.inverse();
  const Gaussian6 density(Vector6d::Zero(), covariance);
  constexpr int kSamples = 200000;
  double sum = 0.0, sum_of_squares = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const Pose pose = informed.sample(uniform(i), normal(i));
    const Vector6d delta = difference(pose, reference);
    const double log_density = density.logDensity(delta) - logRotationVolume(delta.tail<3>());
    const double ratio = std::exp(log_density - informed.logDensity(pose));
    sum += ratio;
    sum_of_squares += ratio * ratio;
  }
  const double mean = sum / kSamples, stderr_mean = std::sqrt((sum_of_squares / kSamples - mean * mean) / kSamples);
  std::printf("integral %.4f +- %.4f\n", mean, stderr_mean);
  EXPECT_LT(stderr_mean, 0.01) << "else the test shows nothing";
  EXPECT_NEAR(mean, 1.0, kStandardErrors * stderr_mean);
}

TEST_F(InformedProposalDensity, IsTheProductOfPriorAndModelForOneExactMode) {
  const ProcessStep step = stepOf(randomWalk(0.05, 0.02), kFrameS);
  LocalMode mode = modes_.front();
  mode.pose = Pose::Identity();
  const Vector6d predicted = (Vector6d() << 0.002, 0, 0, 0.001, 0, 0).finished();
  const InformedProposal proposal(step, {mode});
  const InformedProposal::ForParticle informed(proposal, perturb(Pose::Identity(), predicted));
  const Matrix6d prior = step.component(0).variances.cwiseInverse().asDiagonal();
  const Vector6d mean = (prior + mode.information).ldlt().solve(mode.slope + prior * predicted);
  EXPECT_LT((ToyLikelihood::vectorOf(informed.sample(0.5, Vector6d::Zero())) - mean).norm(), 1e-9);
  const double at_mean = informed.logDensity(perturb(Pose::Identity(), mean));
  for (int axis = 0; axis < 6; ++axis) {
    const Vector6d away = mean + 0.01 * Vector6d::Unit(axis);
    EXPECT_LT(informed.logDensity(perturb(Pose::Identity(), away)), at_mean);
  }
}

TEST_F(InformedProposalDensity, WithoutModesThereIsNone) {
  EXPECT_TRUE(InformedProposal(step_, {}).empty());
}

}  // namespace
}  // namespace depth_object_tracker
