// SPDX-License-Identifier: BSD-3-Clause
// Weights and systematic resampling, degenerate input included.
#include "depth_object_tracker/filter/resampling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace depth_object_tracker {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<double> randomWeights(std::size_t count, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::exponential_distribution<double> exponential;
  std::vector<double> weights(count);
  for (double& weight : weights) weight = std::pow(exponential(engine), 3);
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights) weight /= sum;
  return weights;
}

std::vector<int> offspring(const std::vector<int>& source) {
  std::vector<int> count(source.size(), 0);
  for (const int parent : source) ++count.at(static_cast<std::size_t>(parent));
  return count;
}

TEST(NormaliseLogWeights, GivesWeightsThatSumToOneAndTheEvidence) {
  std::vector<double> weights;
  const double log_evidence = normaliseLogWeights({std::log(1.0), std::log(2.0), std::log(5.0)}, weights);
  ASSERT_EQ(weights.size(), 3u);
  EXPECT_NEAR(weights[0], 0.125, 1e-15);
  EXPECT_NEAR(weights[1], 0.25, 1e-15);
  EXPECT_NEAR(weights[2], 0.625, 1e-15);
  EXPECT_NEAR(log_evidence, std::log(8.0 / 3.0), 1e-14);
}

TEST(NormaliseLogWeights, SurvivesThousandsOfNats) {
  std::vector<double> weights;
  const double log_evidence = normaliseLogWeights({-90000.0, -90001.0}, weights);
  EXPECT_NEAR(weights[0] / weights[1], std::exp(1.0), 1e-9);
  EXPECT_NEAR(log_evidence, -90000.0 + std::log(0.5 * (1.0 + std::exp(-1.0))), 1e-9);
  normaliseLogWeights({90000.0, 80000.0}, weights);
  EXPECT_EQ(weights[0], 1.0);
  EXPECT_EQ(weights[1], 0.0);
}

TEST(NormaliseLogWeights, NanAndInfinityGetNoWeight) {
  std::vector<double> weights;
  normaliseLogWeights({kNan, 0.0, -kInfinity, 0.0, kInfinity}, weights);
  EXPECT_EQ(weights, (std::vector<double>{0.0, 0.5, 0.0, 0.5, 0.0}));
}

TEST(NormaliseLogWeights, WithoutAnyPositiveWeightAllAreEqual) {
  std::vector<double> weights;
  for (const double none : {-kInfinity, kNan}) {
    EXPECT_EQ(normaliseLogWeights({none, none, none, none}, weights), -kInfinity);
    EXPECT_EQ(weights, std::vector<double>(4, 0.25));
  }
  EXPECT_EQ(normaliseLogWeights({}, weights), -kInfinity);
  EXPECT_TRUE(weights.empty());
}

TEST(EffectiveSampleSize, IsBetweenOneAndTheCount) {
  EXPECT_NEAR(effectiveSampleSize(std::vector<double>(50, 0.02)), 50.0, 1e-9);
  EXPECT_EQ(effectiveSampleSize({0.0, 1.0, 0.0}), 1.0);
  EXPECT_NEAR(effectiveSampleSize({0.5, 0.5, 0.0, 0.0}), 2.0, 1e-15);
  EXPECT_EQ(effectiveSampleSize({}), 0.0);
  EXPECT_EQ(effectiveSampleSize({0.0, 0.0}), 0.0);
}

TEST(ResampleSystematic, MeanOffspringIsTheWeightTimesTheCount) {
  constexpr int kOffsets = 20000;
  const std::vector<double> weights = randomWeights(37, 1);
  std::vector<double> mean(weights.size(), 0.0);
  for (int k = 0; k < kOffsets; ++k) {
    const std::vector<int> count = offspring(resampleSystematic(weights, (k + 0.5) / kOffsets));
    for (std::size_t i = 0; i < count.size(); ++i) mean[i] += static_cast<double>(count[i]) / kOffsets;
  }
  // Offsets on an even grid: each particle's mean is off by at most one offset's worth at either end of its interval.
  for (std::size_t i = 0; i < weights.size(); ++i) EXPECT_NEAR(mean[i], 37.0 * weights[i], 2.0 / kOffsets + 1e-9) << i;
}

TEST(ResampleSystematic, OffspringIsTheFloorOrCeiling) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const std::vector<double> weights = randomWeights(100, seed);
    for (const double offset : {0.0, 0.1, 0.5, 0.9, 0.999999}) {
      const std::vector<int> count = offspring(resampleSystematic(weights, offset));
      for (std::size_t i = 0; i < count.size(); ++i) {
        EXPECT_GE(count[i], std::floor(100.0 * weights[i] - 1e-9));
        EXPECT_LE(count[i], std::ceil(100.0 * weights[i] + 1e-9));
      }
    }
  }
}

TEST(ResampleSystematic, SurvivorsKeepTheirSlot) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const std::vector<double> weights = randomWeights(64, seed);
    const std::vector<int> source = resampleSystematic(weights, 0.37);
    const std::vector<int> count = offspring(source);
    for (std::size_t i = 0; i < source.size(); ++i) {
      if (count[i] > 0) {
        EXPECT_EQ(source[i], static_cast<int>(i)) << "particle " << i << " survives but has moved";
      }
    }
  }
}

TEST(ResampleSystematic, EqualWeightsChangeNothing) {
  for (const double offset : {0.0, 0.3, 0.999}) {
    const std::vector<int> source = resampleSystematic(std::vector<double>(97, 1.0 / 97.0), offset);
    for (std::size_t i = 0; i < source.size(); ++i) EXPECT_EQ(source[i], static_cast<int>(i));
  }
}

TEST(ResampleSystematic, OneParticleTakesAll) {
  for (const std::size_t winner : {0u, 4u, 9u}) {
    std::vector<double> weights(10, 0.0);
    weights[winner] = 1.0;
    for (const double offset : {0.0, 0.5, 0.999999}) {
      EXPECT_EQ(resampleSystematic(weights, offset), std::vector<int>(10, static_cast<int>(winner)));
    }
  }
  EXPECT_EQ(resampleSystematic({1.0}, 0.7), std::vector<int>{0});
  EXPECT_TRUE(resampleSystematic({}, 0.7).empty());
}

TEST(ResampleSystematic, AnotherCountKeepsProportionsAndSlots) {
  const std::vector<double> weights = randomWeights(50, 3);
  for (const std::size_t count : {1u, 7u, 49u, 51u, 500u}) {
    const std::vector<int> source = resampleSystematic(weights, 0.4, count);
    ASSERT_EQ(source.size(), count);
    std::vector<int> children(weights.size(), 0);
    for (const int parent : source) ++children.at(static_cast<std::size_t>(parent));
    for (std::size_t i = 0; i < weights.size(); ++i) {
      EXPECT_NEAR(children[i], static_cast<double>(count) * weights[i], 1.0) << count << " slots, particle " << i;
      if (i < count && children[i] > 0) {
        EXPECT_EQ(source[i], static_cast<int>(i)) << "survives but has moved";
      }
    }
  }
}

TEST(ResampleSystematic, ParticlesWithoutWeightNeverSurvive) {
  std::vector<double> weights(30, 0.0);
  for (std::size_t i = 0; i < 30; i += 3) weights[i] = 0.1 * (1.0 - 1e-14);  // the sum falls short by rounding
  for (const double offset : {0.0, 0.5, 1.0 - 1e-15}) {
    const std::vector<int> source = resampleSystematic(weights, offset);
    ASSERT_EQ(source.size(), 30u);
    for (const int parent : source) EXPECT_EQ(parent % 3, 0);
  }
}

}  // namespace
}  // namespace depth_object_tracker
