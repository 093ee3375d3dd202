// SPDX-License-Identifier: BSD-3-Clause
// The particle filter on linear-Gaussian toys against the closed-form Kalman filter.
#include "depth_object_tracker/filter/particle_filter.h"

#include "seed_statistics.h"
#include "toy_likelihood.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>

namespace depth_object_tracker {
namespace {

constexpr double kFrameS = 1.0 / 30.0;
constexpr int kFrames = 20;
constexpr int kSeeds = 16;
constexpr int kParticles = 2000;
constexpr double kRadiusM = 0.1;
// Mean errors over the seeds in units of their own standard error: Student's t with 15 degrees of freedom, beyond 6.5
// in one of 100,000 cases. The filter's own bias, of order 1 / N, is a fiftieth of that.
constexpr double kLargestT = 6.5;
// And in posterior standard deviations, so that large but unsteady errors fail too.
constexpr double kLargestError = 0.25;

/// Kalman filter of a random walk that is measured as a whole.
class KalmanFilter {
 public:
  KalmanFilter() : mean_(Vector6d::Zero()), covariance_(Matrix6d::Zero()) {}
  void predict(const Vector6d& noise_variances) { covariance_.diagonal() += noise_variances; }
  void update(const Vector6d& measured, const Matrix6d& information) {
    const Matrix6d gain = covariance_ * (Matrix6d::Identity() + information * covariance_).inverse() * information;
    mean_ += gain * (measured - mean_);
    covariance_ = (Matrix6d::Identity() - gain) * covariance_;
  }
  const Vector6d& mean() const { return mean_; }
  const Matrix6d& covariance() const { return covariance_; }

 private:
  Vector6d mean_;
  Matrix6d covariance_;
};

struct ToyCase {
  Proposal proposal;
  double resampling_threshold;
  double exponent;
};

std::ostream& operator<<(std::ostream& out, const ToyCase& toy) {
  return out << (toy.proposal == Proposal::kInformed ? "informed" : "process") << ", resampling below "
             << toy.resampling_threshold << ", exponent " << toy.exponent;
}

/// One frame's measurement with everything that both filters need.
struct ToyFrame {
  ProcessStep step;
  Vector6d measured;
  Vector6d kalman_mean;
  Matrix6d kalman_covariance;
};

class AgainstKalman : public testing::TestWithParam<ToyCase> {
 protected:
  /// Runs both filters on the same measurements; checks the first `dimensions` axes in every frame.
  void compare(const Matrix6d& information, const Vector6d& initial_variances, const ProcessConfig& process,
               int dimensions) {
    const std::vector<ToyFrame> frames = simulate(information, initial_variances, process);
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) run(frames, information, dimensions, seed);
    double worst = 0.0;
    for (const auto& [name, statistics] : errors_) {
      worst = std::max(worst, statistics.studentT());
      EXPECT_LT(std::abs(statistics.mean()), kLargestError) << name;
      EXPECT_LT(statistics.studentT(), kLargestT)
          << name << ": " << statistics.mean() << " +- " << statistics.standardError();
    }
    std::printf("%zu quantities, largest mean error over %d seeds: %.1f standard errors\n", errors_.size(), kSeeds,
                worst);
  }

 private:
  std::vector<ToyFrame> simulate(const Matrix6d& information, const Vector6d& initial_variances,
                                 const ProcessConfig& process) {
    std::vector<ToyFrame> frames;
    KalmanFilter kalman;
    for (int k = 0; k < kFrames; ++k) {
      const ProcessStep step = k == 0 ? ProcessStep(process, initial_variances) : stepOf(process, kFrameS);
      const Vector6d walk = step.component(0).variances, measured = nextMeasurement(walk, information);
      kalman.predict(walk);
      kalman.update(measured, GetParam().exponent * information);
      frames.push_back({step, measured, kalman.mean(), kalman.covariance()});
    }
    return frames;
  }

  Vector6d nextMeasurement(const Vector6d& walk, const Matrix6d& information) {
    Vector6d noise;
    for (int axis = 0; axis < 6; ++axis) {
      truth_[axis] += 0.7 * std::sqrt(walk[axis]) * normal_(engine_);
      noise[axis] = information(axis, axis) > 0.0 ? normal_(engine_) / std::sqrt(information(axis, axis)) : 0.0;
    }
    return truth_ + noise;
  }

  void run(const std::vector<ToyFrame>& frames, const Matrix6d& information, int dimensions, std::uint64_t seed) {
    FilterConfig config;
    config.proposal = GetParam().proposal;
    config.resampling_threshold = GetParam().resampling_threshold;
    config.num_particles = kParticles;
    config.seed = seed;
    ParticleFilter filter(config, kRadiusM, Symmetries());
    filter.initialise(Pose::Identity());
    for (std::size_t k = 0; k < frames.size(); ++k) {
      ToyLikelihood likelihood = gaussianToy(frames[k].measured, information);
      record(filter.update(likelihood, frames[k].step, GetParam().exponent), frames[k], dimensions,
             "frame " + std::to_string(k));
    }
  }

  void record(const FilterEstimate& estimate, const ToyFrame& frame, int dimensions, const std::string& name) {
    const Vector6d mean = ToyLikelihood::vectorOf(estimate.pose.mean);
    for (int i = 0; i < dimensions; ++i) {
      const double stddev = std::sqrt(frame.kalman_covariance(i, i));
      const double error = (mean[i] - frame.kalman_mean[i]) / stddev;
      errors_[name + ", mean of axis " + std::to_string(i)].add(error);
      for (int j = 0; j <= i; ++j) {
        const double scale = stddev * std::sqrt(frame.kalman_covariance(j, j));
        const double deviation = (estimate.pose.covariance(i, j) - frame.kalman_covariance(i, j)) / scale;
        errors_[name + ", covariance " + std::to_string(i) + " " + std::to_string(j)].add(deviation);
      }
    }
  }

  std::mt19937_64 engine_{42};
  std::normal_distribution<double> normal_;
  Vector6d truth_ = Vector6d::Zero();
  std::map<std::string, SeedStatistics> errors_;
};
INSTANTIATE_TEST_SUITE_P(Toys, AgainstKalman,
                         testing::Values(ToyCase{Proposal::kProcess, 0.5, 1.0}, ToyCase{Proposal::kInformed, 0.5, 1.0},
                                         ToyCase{Proposal::kProcess, 1.0, 1.0},
                                         ToyCase{Proposal::kInformed, 0.5, 0.3}));

TEST_P(AgainstKalman, OneAxisMeasured) {
  Matrix6d information = Matrix6d::Zero();
  information(0, 0) = 1.0 / (0.004 * 0.004);
  const Vector6d initial = (Vector6d() << 4e-5, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6).finished();
  compare(information, initial, randomWalk(0.02, 0.002), 1);
}

TEST_P(AgainstKalman, SixAxesMeasuredWithCorrelatedNoise) {
  // Rotations stay below 0.02 rad: what the chart bends there is far below the Monte Carlo error.
  const double position = 0.012, rotation = 0.006;
  Vector6d stddev;
  stddev << position, 0.7 * position, 1.5 * position, rotation, 1.5 * rotation, 0.7 * rotation;
  Matrix6d correlation = Matrix6d::Identity();
  correlation(0, 4) = correlation(4, 0) = 0.6;
  correlation(1, 3) = correlation(3, 1) = -0.5;
  correlation(2, 0) = correlation(0, 2) = 0.3;
  const Matrix6d information = (stddev.asDiagonal() * correlation * stddev.asDiagonal()).inverse();
  const Vector6d initial = (Vector6d() << 3e-5, 3e-5, 3e-5, 6e-6, 6e-6, 6e-6).finished();
  compare(information, initial, randomWalk(0.02, 0.01), 6);
}

}  // namespace
}  // namespace depth_object_tracker
