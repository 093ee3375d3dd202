// SPDX-License-Identifier: BSD-3-Clause
// Counter-based random numbers: distribution, independence, reproducibility.
#include "depth_object_tracker/filter/random.h"

#include <gtest/gtest.h>

#include <cstring>
#include <set>
#include <vector>

namespace depth_object_tracker {
namespace {

TEST(CounterRandom, UniformHasItsMomentsAndStaysInside) {
  const CounterRandom source(7);
  constexpr int kDraws = 200000;
  double sum = 0.0, sum_of_squares = 0.0, lag = 0.0, last = 0.5;
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    const double u = source.uniform(RandomPurpose::kResampling, 3, i);
    ASSERT_GT(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
    sum_of_squares += u * u;
    lag += (u - 0.5) * (last - 0.5);
    last = u;
  }
  // Five standard errors: sqrt(1/12), sqrt(4/45) and 1/12 over sqrt(n).
  EXPECT_NEAR(sum / kDraws, 0.5, 5.0 * 0.2887 / std::sqrt(kDraws));
  EXPECT_NEAR(sum_of_squares / kDraws, 1.0 / 3.0, 5.0 * 0.2981 / std::sqrt(kDraws));
  EXPECT_NEAR(lag / kDraws, 0.0, 5.0 * 0.0833 / std::sqrt(kDraws));
}

TEST(CounterRandom, NormalHasUnitCovarianceAndGaussianTails) {
  const CounterRandom source(11);
  constexpr int kDraws = 100000;
  Vector6d mean = Vector6d::Zero(), fourth = Vector6d::Zero();
  Matrix6d second = Matrix6d::Zero();
  int beyond_two = 0;
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    const Vector6d x = source.normal6(RandomPurpose::kProposal, 1, i);
    mean += x / kDraws;
    second += x * x.transpose() / kDraws;
    fourth += x.array().pow(4).matrix() / kDraws;
    beyond_two += static_cast<int>((x.array().abs() > 2.0).count());
  }
  const double error = 5.0 / std::sqrt(kDraws);
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), error);
  EXPECT_LT((second - Matrix6d::Identity()).cwiseAbs().maxCoeff(), std::sqrt(2.0) * error);
  EXPECT_LT((fourth.array() - 3.0).abs().maxCoeff(), std::sqrt(96.0) * error);
  EXPECT_NEAR(beyond_two / (6.0 * kDraws), 0.0455, 5.0 * std::sqrt(0.0455 / (6.0 * kDraws)));
}

TEST(CounterRandom, SameCounterSameBytesInAnyOrder) {
  const CounterRandom source(123), again(123);
  std::vector<Vector6d> forward, backward(50);
  for (std::uint32_t i = 0; i < 50; ++i) forward.push_back(source.normal6(RandomPurpose::kProposal, 9, i));
  for (std::uint32_t i = 50; i-- > 0;) backward[i] = again.normal6(RandomPurpose::kProposal, 9, i);
  EXPECT_EQ(std::memcmp(forward.data(), backward.data(), 50 * sizeof(Vector6d)), 0);
}

TEST(CounterRandom, EveryPartOfTheCounterMatters) {
  std::set<double> draws;
  const std::uint64_t far = std::uint64_t{1} << 40;
  int expected = 0;
  for (const std::uint64_t seed : {std::uint64_t{1}, std::uint64_t{2}, far}) {
    for (const RandomPurpose purpose :
         {RandomPurpose::kInitialPose, RandomPurpose::kProposal, RandomPurpose::kComponent, RandomPurpose::kResampling,
          RandomPurpose::kSearch}) {
      for (const std::uint64_t frame : {std::uint64_t{0}, std::uint64_t{1}, far}) {
        for (const std::uint32_t index : {0u, 1u, 4000000000u}) {
          draws.insert(CounterRandom(seed).uniform(purpose, frame, index));
          draws.insert(CounterRandom(seed).normal6(purpose, frame, index)[0]);
          expected += 2;
        }
      }
    }
  }
  EXPECT_EQ(draws.size(), static_cast<std::size_t>(expected));
}

TEST(CounterRandom, NeighbouringStreamsAreUncorrelated) {
  constexpr int kDraws = 50000;
  const CounterRandom source(1), other_seed(2);
  Vector6d frames = Vector6d::Zero(), indices = Vector6d::Zero(), seeds = Vector6d::Zero();
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    const Vector6d x = source.normal6(RandomPurpose::kProposal, 1, i);
    frames += x.cwiseProduct(source.normal6(RandomPurpose::kProposal, 2, i)) / kDraws;
    indices += x.cwiseProduct(source.normal6(RandomPurpose::kProposal, 1, i + 1)) / kDraws;
    seeds += x.cwiseProduct(other_seed.normal6(RandomPurpose::kProposal, 1, i)) / kDraws;
  }
  const double error = 5.0 / std::sqrt(kDraws);
  EXPECT_LT(frames.cwiseAbs().maxCoeff(), error);
  EXPECT_LT(indices.cwiseAbs().maxCoeff(), error);
  EXPECT_LT(seeds.cwiseAbs().maxCoeff(), error);
}

}  // namespace
}  // namespace depth_object_tracker
