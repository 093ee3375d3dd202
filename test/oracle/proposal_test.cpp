// SPDX-License-Identifier: BSD-3-Clause
// Both proposals give the same posterior, whatever the likelihood looks like and however wrong its local model is.
#include "depth_object_tracker/filter/particle_filter.h"

#include "seed_statistics.h"
#include "toy_along_x.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

namespace depth_object_tracker {
namespace {

constexpr double kFrameS = 1.0 / 30.0;
constexpr int kParticles = 100000;
constexpr double kRadiusM = 0.1;
constexpr double kStandardErrors = 5.0;

struct ProposalCase {
  AlongX model;
  double sudden_motion_share;
  double exponent;
};

std::ostream& operator<<(std::ostream& out, const ProposalCase& test) {
  return out << test.model.name << ", sudden motion " << test.sudden_motion_share << ", exponent " << test.exponent;
}

class Proposals : public testing::TestWithParam<ProposalCase> {
 protected:
  static FilterConfig configOf(Proposal proposal, int num_particles) {
    FilterConfig config;
    config.proposal = proposal;
    config.num_particles = num_particles;
    return config;
  }

  ProcessConfig process() const {
    ProcessConfig config = randomWalk(0.035, 0.002);
    config.sudden_motion_share = GetParam().sudden_motion_share;
    return config;
  }

  /// Mean, variance and share of probability at x > 0.
  struct Summary {
    double mean, variance, share_right;
  };

  static Summary summarise(const FilterEstimate& estimate, const ParticleFilter& filter) {
    Summary summary{estimate.pose.mean.translation().x(), estimate.pose.covariance(0, 0), 0.0};
    for (std::size_t i = 0; i < filter.poses().size(); ++i) {
      if (filter.poses()[i].translation().x() > 0.0) summary.share_right += filter.weights()[i];
    }
    return summary;
  }

  static Summary summarise(const GridFilter& grid) {
    const double mean = grid.expect([](double x) { return x; });
    return {mean, grid.expect([&](double x) { return (x - mean) * (x - mean); }), grid.expect([](double x) {
              return x > 0.0 ? 1.0 : x < 0.0 ? 0.0 : 0.5;
            })};
  }
};
INSTANTIATE_TEST_SUITE_P(
    Toys, Proposals,
    testing::Values(ProposalCase{gaussianAlongX(), 0.0, 1.0}, ProposalCase{gaussianAlongX(), 0.05, 1.0},
                    ProposalCase{gaussianAlongX(), 0.02, 0.25}, ProposalCase{gaussianAlongX(0.008), 0.0, 1.0},
                    ProposalCase{gaussianAlongX(-0.01, 4.0), 0.02, 1.0},
                    ProposalCase{gaussianAlongX(0.0, 16.0), 0.0, 1.0},
                    ProposalCase{gaussianAlongX(0.0, 0.05), 0.0, 1.0}, ProposalCase{bimodalAlongX(), 0.0, 1.0},
                    ProposalCase{bimodalAlongX(), 0.05, 0.5}, ProposalCase{asymmetricAlongX(), 0.0, 1.0},
                    ProposalCase{asymmetricAlongX(), 0.05, 1.0}));

TEST_P(Proposals, GiveTheSamePosteriorAsNumericalIntegration) {
  const ProcessStep step = stepOf(process(), kFrameS);
  GridFilter grid;
  grid.predict(step);
  grid.update(GetParam().model, GetParam().exponent);
  const Summary truth = summarise(grid);
  const double fourth = grid.expect([&](double x) { return std::pow(x - truth.mean, 4); });
  for (const Proposal proposal : {Proposal::kProcess, Proposal::kInformed}) {
    SCOPED_TRACE(proposal == Proposal::kInformed ? "informed" : "process");
    ParticleFilter filter(configOf(proposal, kParticles), kRadiusM, Symmetries());
    filter.initialise(Pose::Identity());
    ToyLikelihood likelihood = toyOf(GetParam().model);
    const FilterEstimate estimate = filter.update(likelihood, step, GetParam().exponent);
    const Summary found = summarise(estimate, filter);
    // Standard errors of n independent draws from the posterior, n the effective sample size.
    const double error = kStandardErrors / std::sqrt(estimate.effective_sample_size);
    EXPECT_GT(estimate.effective_sample_size, 0.01 * kParticles);
    EXPECT_NEAR(found.mean, truth.mean, error * std::sqrt(truth.variance));
    EXPECT_NEAR(found.variance, truth.variance, error * std::sqrt(fourth - truth.variance * truth.variance));
    EXPECT_NEAR(found.share_right, truth.share_right,
                error * std::sqrt(truth.share_right * (1.0 - truth.share_right)) + 1e-4);
  }
}

TEST_P(Proposals, StayOnTheTrueFilterOverManyFrames) {
  constexpr int kSeeds = 16, kFrames = 6;
  constexpr double kLargestT = 6.5;  // Student's t, 15 degrees of freedom: beyond it in one of 100,000 cases
  const ProcessStep step = stepOf(process(), kFrameS);
  std::vector<Summary> truth;
  GridFilter grid;
  for (int frame = 0; frame < kFrames; ++frame) {
    grid.predict(step);
    grid.update(GetParam().model, GetParam().exponent);
    truth.push_back(summarise(grid));
  }
  double largest = 0.0;
  for (const Proposal proposal : {Proposal::kProcess, Proposal::kInformed}) {
    SCOPED_TRACE(proposal == Proposal::kInformed ? "informed" : "process");
    std::vector<SeedStatistics> mean(kFrames), share(kFrames);
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      FilterConfig config = configOf(proposal, 2000);
      config.seed = seed;
      ParticleFilter filter(config, kRadiusM, Symmetries());
      filter.initialise(Pose::Identity());
      ToyLikelihood likelihood = toyOf(GetParam().model);
      for (std::size_t k = 0; k < kFrames; ++k) {
        const Summary found = summarise(filter.update(likelihood, step, GetParam().exponent), filter);
        mean[k].add((found.mean - truth[k].mean) / std::sqrt(truth[k].variance));
        share[k].add(found.share_right - truth[k].share_right);
      }
    }
    for (std::size_t k = 0; k < kFrames; ++k) {
      largest = std::max({largest, mean[k].studentT(), share[k].studentT()});
      EXPECT_LT(mean[k].studentT(), kLargestT)
          << "frame " << k << ": " << mean[k].mean() << " +- " << mean[k].standardError();
      EXPECT_LT(std::abs(mean[k].mean()), 0.1) << "frame " << k << ", in posterior standard deviations";
      if (truth[k].share_right < 0.01 || truth[k].share_right > 0.99) continue;  // few particles there: no Student's t
      EXPECT_LT(share[k].studentT(), kLargestT)
          << "frame " << k << ": " << share[k].mean() << " +- " << share[k].standardError();
    }
  }
  std::printf("largest mean error over %d seeds: %.1f standard errors\n", kSeeds, largest);
}

/// Six axes, heavy tails: a Gaussian and a wider one beside it.
ToyLikelihood heavyTailedToy(const Vector6d& model_error) {
  const Vector6d measured = (Vector6d() << 0.003, -0.004, 0.002, 0.004, 0.0, -0.003).finished();
  const Vector6d information = (Vector6d() << 4e4, 6e4, 5e4, 7e4, 6e4, 9e4).finished();
  const auto squared = [=](const Vector6d& x) { return (x - measured).cwiseAbs2().dot(information); };
  return {[=](const Vector6d& x) {
            return std::log(0.8 * std::exp(-0.5 * squared(x)) + 0.2 * std::exp(-0.05 * squared(x)));
          },
          [=](const Vector6d& x) {
            const Vector6d residual = measured + model_error - x;
            return Linearisation{information.cwiseProduct(residual), information.asDiagonal()};
          }};
}

TEST(ProposalsInSixDimensions, GiveTheSamePosteriorMean) {
  ProcessConfig process = randomWalk(0.022, 0.018);
  for (const double sudden_share : {0.0, 0.05}) {
    process.sudden_motion_share = sudden_share;
    process.sudden_motion_scale = 3.0;
    const ProcessStep step = stepOf(process, kFrameS);
    for (const double model_error : {0.0, 0.008}) {
      std::vector<FilterEstimate> estimates;
      for (const Proposal proposal : {Proposal::kProcess, Proposal::kInformed}) {
        FilterConfig config;
        config.proposal = proposal;
        config.num_particles = kParticles;
        ParticleFilter filter(config, kRadiusM, Symmetries());
        filter.initialise(Pose::Identity());
        ToyLikelihood likelihood = heavyTailedToy(Vector6d::Constant(model_error));
        estimates.push_back(filter.update(likelihood, step, 1.0));
      }
      const double rate = 1.0 / estimates[0].effective_sample_size + 1.0 / estimates[1].effective_sample_size;
      const Vector6d difference =
          ToyLikelihood::vectorOf(estimates[0].pose.mean) - ToyLikelihood::vectorOf(estimates[1].pose.mean);
      for (int axis = 0; axis < 6; ++axis) {
        const double variance = estimates[1].pose.covariance(axis, axis);
        EXPECT_NEAR(difference[axis], 0.0, kStandardErrors * std::sqrt(variance * rate)) << "axis " << axis;
        EXPECT_NEAR(estimates[0].pose.covariance(axis, axis), variance,
                    kStandardErrors * variance * std::sqrt(4.0 * rate));
      }
      std::printf("sudden %.2f, model off by %.3f: effective samples %.0f process, %.0f informed\n", sudden_share,
                  model_error, estimates[0].effective_sample_size, estimates[1].effective_sample_size);
    }
  }
}

/// Two peaks along x: the object is at the near one, of which half is hidden; the far one covers more of the image.
class TwoPlaces : public ToyLikelihood {
 public:
  explicit TwoPlaces(bool far_explains)
      : ToyLikelihood([](const Vector6d& x) { return std::max(nat(x, 0.0, kNearNat), nat(x, kFarM, kFarNat)); },
                      [](const Vector6d& x) {
                        const Vector6d at = Vector6d::Unit(0) * (x[0] > 0.5 * kFarM ? kFarM : 0.0);
                        return Linearisation{kInformation * (at - x), kInformation * Matrix6d::Identity()};
                      }),
        far_explains_(far_explains) {}

  bool explains(const Pose& pose) override { return far_explains_ && vectorOf(pose)[0] > 0.5 * kFarM; }

  static constexpr double kFarM = 0.06, kNearNat = 40.0, kFarNat = 60.0, kInformation = 1e6;

 private:
  static double nat(const Vector6d& x, double at, double peak) {
    return peak - 0.5 * kInformation * (x - at * Vector6d::Unit(0)).squaredNorm();
  }
  bool far_explains_;
};

TEST(FarHypotheses, MustExplainWhatTheyCover) {
  ProcessConfig process = randomWalk(0.05, 0.05);
  process.sudden_motion_share = 0.02;
  process.sudden_motion_scale = 6.0;
  Hypotheses hypotheses;
  hypotheses.if_poor = {perturb(Pose::Identity(), TwoPlaces::kFarM * Vector6d::Unit(0))};
  for (const bool far_explains : {false, true}) {
    ParticleFilter filter(FilterConfig(), kRadiusM, Symmetries());
    filter.initialise(Pose::Identity());
    TwoPlaces likelihood(far_explains);
    FilterEstimate estimate;
    for (int k = 0; k < 3; ++k) estimate = filter.update(likelihood, stepOf(process, kFrameS), 1.0, hypotheses);
    EXPECT_NEAR(estimate.pose.mean.translation().x(), far_explains ? TwoPlaces::kFarM : 0.0, 0.005) << far_explains;
  }
}

/// The climb ends where nothing can be said, and the image is so clear that one draw outweighs all others.
TEST(WithoutAMode, TheCovarianceIsNotThatOfOneDraw) {
  const Vector6d truth = 0.003 * Vector6d::Ones();
  ToyLikelihood likelihood(
      [&](const Vector6d& x) {
        return x.norm() < 1e-9 ? -std::numeric_limits<double>::infinity() : -1e9 * (x - truth).squaredNorm();
      },
      [](const Vector6d&) {
        return Linearisation{Vector6d::Zero(), Matrix6d::Zero()};
      });
  ParticleFilter filter(FilterConfig(), kRadiusM, Symmetries());
  filter.initialise(Pose::Identity());
  const ProcessStep step = stepOf(randomWalk(0.02, 0.02), kFrameS);
  const FilterEstimate estimate = filter.update(likelihood, step, 1.0);
  ASSERT_LT(estimate.effective_sample_size, 1.5);
  for (int axis = 0; axis < 6; ++axis) {
    EXPECT_GT(estimate.pose.covariance(axis, axis), 0.5 * step.component(0).variances[axis]);
  }
}

}  // namespace
}  // namespace depth_object_tracker
