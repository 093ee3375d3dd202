// SPDX-License-Identifier: BSD-3-Clause
// The closed-form pixel densities against their definition: normalisation and the integrals over a and b.
#include "depth_object_tracker/model/pixel_likelihood.h"

#include "quadrature.h"

#include <gtest/gtest.h>

#include <limits>

namespace depth_object_tracker {
namespace {

// Where integrals over (0, inf) end. Beyond max_depth_m the uniform tail is over, and of the occluders' exponential
// density less than 1e-9 is left at 30 m. The closed form itself must not be followed much farther: sigma_c(z) grows
// with z^2, so that exp(lambda^2 sigma_c^2 / 2) outgrows exp(-lambda z) from about 70 m on, where no camera measures.
constexpr double kFarM = 30.0;

PixelModelConfig paperModel() {
  PixelModelConfig config;
  config.occluder_model = OccluderModel::kPaper;
  return config;
}

/// Break points for a density with a peak or step at depth d.
std::vector<double> breaksAround(double d, const PixelModelConfig& config) {
  const double reach = 12.0 * surfaceNoiseStddev(d, config);
  return {0.0, d - reach, d - 0.25 * reach, d, d + 0.25 * reach, d + reach, config.max_depth_m, kFarM};
}

/// Camera model p(z | b) of design section 2.
double cameraDensity(double z, double b, const PixelModelConfig& config) {
  const double tail = z > 0.0 && z < config.max_depth_m ? 1.0 / config.max_depth_m : 0.0;
  return (1.0 - config.tail_weight) * normalDensity(z, b, config.depth_noise_per_m * z * z) + config.tail_weight * tail;
}

/// Integral over b of density(b) p(z | b); `density` is 0 beyond `end`.
template <typename Density>
double integrateOverB(double z, double end, const PixelModelConfig& config, const Density& density) {
  const double noise = config.depth_noise_per_m * z * z;
  std::vector<double> breaks = {0.0, end};
  for (const double t : {-9.0, -3.0, 0.0, 3.0, 9.0}) {
    const double b = z + t * noise;
    if (b > 0.0 && b < end) breaks.push_back(b);
  }
  return integratePieces([&](double b) { return density(b) * cameraDensity(z, b, config); }, breaks, 12);
}

double visibleMarginal(double z, double d, const PixelModelConfig& config) {
  const double noise = config.object_noise_stddev_m;
  const auto integrand = [&](double a) { return normalDensity(a, d, noise) * cameraDensity(z, a, config); };
  return integrate(integrand, d - 9.0 * noise, d + 9.0 * noise, 1500);
}

double occludedMarginal(double z, double d, const PixelModelConfig& config) {
  const double rate = std::log(2.0) / config.occluder_half_life_m;
  const double noise = config.object_noise_stddev_m;
  const auto given_a = [&](double a) {
    return integrateOverB(z, a, config,
                          [&](double b) { return rate * std::exp(-rate * b) / (1.0 - std::exp(-rate * a)); });
  };
  return integrate([&](double a) { return normalDensity(a, d, noise) * given_a(a); }, d - 9.0 * noise, d + 9.0 * noise,
                   60);
}

double missMarginal(double z, const PixelModelConfig& config) {
  const double rate = std::log(2.0) / config.occluder_half_life_m;
  return integrateOverB(z, kFarM + 10.0, config, [&](double b) { return rate * std::exp(-rate * b); });
}

/// Readings in front of, at and behind depth d.
std::vector<double> readingsAround(double d, const PixelModelConfig& config) {
  std::vector<double> readings = {0.15 * d, 0.4 * d, 0.7 * d, 0.9 * d, 0.97 * d};
  const double stddev = surfaceNoiseStddev(d, config);
  for (double t = -5.0; t <= 8.0; t += 0.5) readings.push_back(d + t * stddev);
  readings.insert(readings.end(), {1.2 * d, 1.4 * d});
  return readings;
}

class AtDepth : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Densities, AtDepth, testing::Values(0.3, 0.6, 1.0, 2.0, 4.0));

TEST_P(AtDepth, VisibleIntegratesToOne) {
  const PixelModelConfig config;
  const double total = integratePieces([&](double z) { return visibleDensity(z, GetParam(), config); },
                                       breaksAround(GetParam(), config), 400);
  EXPECT_NEAR(total, 1.0, 1e-3);
}

TEST_P(AtDepth, PaperOccludedIntegratesToOne) {
  const PixelModelConfig config = paperModel();
  const double total = integratePieces([&](double z) { return occludedDensity(z, GetParam(), config); },
                                       breaksAround(GetParam(), config), 400);
  EXPECT_NEAR(total, 1.0, 1e-3);
}

TEST_P(AtDepth, ConsistentOccludedIntegratesToTheShareOfOccludersInFront) {
  const PixelModelConfig config;
  const double total = integratePieces([&](double z) { return occludedDensity(z, GetParam(), config); },
                                       breaksAround(GetParam(), config), 400);
  const double in_front = 1.0 - std::pow(0.5, GetParam() / config.occluder_half_life_m);
  EXPECT_NEAR(total, (1.0 - config.tail_weight) * in_front + config.tail_weight, 1e-3);
}

TEST(PixelDensities, MissIntegratesToOne) {
  for (const double half_life : {0.5, 1.0, 2.0}) {
    PixelModelConfig config;
    config.occluder_half_life_m = half_life;
    const double total =
        integratePieces([&](double z) { return missDensity(z, config); }, {0.0, 1.0, config.max_depth_m, kFarM}, 800);
    EXPECT_NEAR(total, 1.0, 1e-3) << "half-life " << half_life << " m";
  }
}

TEST_P(AtDepth, VisibleIsTheIntegralOverTheObjectNoise) {
  const PixelModelConfig config;
  for (const double z : readingsAround(GetParam(), config)) {
    const double expected = visibleMarginal(z, GetParam(), config);
    EXPECT_NEAR(visibleDensity(z, GetParam(), config) / expected, 1.0, 1e-6) << "z = " << z;
  }
}

TEST_P(AtDepth, PaperOccludedIsTheIntegralOverObjectAndOccluder) {
  const PixelModelConfig config = paperModel();
  const double tolerance = GetParam() >= 0.6 ? 0.01 : 0.03;
  for (const double z : readingsAround(GetParam(), config)) {
    const double expected = occludedMarginal(z, GetParam(), config);
    EXPECT_NEAR(occludedDensity(z, GetParam(), config) / expected, 1.0, tolerance) << "z = " << z;
  }
}

TEST(PixelDensities, MissIsTheIntegralOverTheOccluder) {
  const PixelModelConfig config;
  for (double z = 0.1; z < 5.9; z += 0.1) {
    EXPECT_NEAR(missDensity(z, config) / missMarginal(z, config), 1.0, 1e-4) << "z = " << z;
  }
}

TEST(PixelDensities, PaperOccludedTendsToMissForAFarObject) {
  const PixelModelConfig config = paperModel();
  for (double z = 0.1; z < 5.9; z += 0.2) {
    EXPECT_NEAR(occludedDensity(z, 100.0, config) / missDensity(z, config), 1.0, 1e-6) << "z = " << z;
  }
}

TEST(PixelDensities, ConsistentOccluderIsASmoothedStepNeverAboveMiss) {
  const PixelModelConfig config;
  for (const double z : {0.3, 0.5, 1.0, 2.0, 4.0, 5.9}) {
    const double stddev = surfaceNoiseStddev(z, config);
    const double miss = missDensity(z, config);
    const double tail = config.tail_weight / config.max_depth_m / miss;
    double last = 0.0;
    for (double d = 0.05; d < z + 1.0; d += 0.1 * stddev) {
      const double ratio = occludedDensity(z, d, config) / miss;
      ASSERT_GE(ratio, last) << "z = " << z << ", d = " << d;
      ASSERT_LE(ratio, 1.0 + 1e-12) << "z = " << z << ", d = " << d;
      last = ratio;
    }
    EXPECT_NEAR(occludedDensity(z, z + 10.0 * stddev, config) / miss, 1.0, 1e-9);
    EXPECT_NEAR(occludedDensity(z, z - 10.0 * stddev, config) / miss, tail, 1e-9);
    const double middle = occludedDensity(z, z, config) / miss;
    EXPECT_NEAR(middle, 0.5 * (1.0 + tail), 0.02) << "z = " << z;
  }
}

TEST(PixelDensities, PaperOccluderRewardsHidingAsMuchAsItsNormaliser) {
  // Why the paper's form is not the default: a covered pixel explains an occluder's reading better than no object does.
  const PixelModelConfig config = paperModel();
  const double reward = std::log(occludedDensity(0.4, 1.0, config) / missDensity(0.4, config));
  EXPECT_NEAR(reward, std::log(2.0), 0.02);
}

TEST(PixelUpdate, IsBayesRuleOverVisibleAndOccluded) {
  for (const OccluderModel model : {OccluderModel::kPaper, OccluderModel::kConsistent}) {
    PixelModelConfig config;
    config.occluder_model = model;
    for (const double z : {0.5, 0.95, 0.999, 1.0, 1.004, 1.5}) {
      for (const double prior : {0.0, 0.1, 0.5, 0.9, 1.0}) {
        const PixelUpdate update = updatePixel(z, 1.0, prior, config);
        const double visible = (1.0 - prior) * visibleDensity(z, 1.0, config);
        const double occluded = prior * occludedDensity(z, 1.0, config);
        EXPECT_NEAR(update.p_occluded, occluded / (visible + occluded), 1e-12);
        EXPECT_NEAR(std::exp(update.log_ratio) * missDensity(z, config), visible + occluded,
                    1e-12 * (visible + occluded));
      }
    }
  }
}

TEST(PixelUpdate, FreeSpaceViolationCostsAboutFiveNat) {
  const PixelUpdate update = updatePixel(1.5, 1.0, 0.25, PixelModelConfig());
  EXPECT_LT(update.log_ratio, -4.0);
  EXPECT_GT(update.log_ratio, -6.0);
}

TEST(PixelUpdate, NoReadingSpeaksAgainstAVisibleSurface) {
  PixelModelConfig config;
  config.no_reading_ratio = 0.25;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double z : {0.0, -1.0, 6.001, nan}) {
    const PixelUpdate update = updatePixel(z, 1.0, 0.2, config);
    EXPECT_NEAR(update.log_ratio, std::log(0.8 * 0.25 + 0.2), 1e-12) << "z = " << z;
    EXPECT_NEAR(update.p_occluded, 0.5, 1e-12) << "0.2 against 0.8 / 4";
    EXPECT_EQ(updatePixel(z, 1.0, 1.0, config).log_ratio, 0.0) << "what hides the object may do so without readings";
  }
}

TEST(PixelUpdate, NoReadingIsNoInformationToThePaper) {
  PixelModelConfig config;
  config.no_reading_ratio = 1.0;
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const double z : {0.0, -1.0, 6.001, 100.0, nan, infinity, -infinity}) {
    const PixelUpdate update = updatePixel(z, 1.0, 0.37, config);
    EXPECT_EQ(update.log_ratio, 0.0) << "z = " << z;
    EXPECT_EQ(update.p_occluded, 0.37) << "z = " << z;
    PixelModelConfig paper;
    paper.occluder_model = OccluderModel::kPaper;
    EXPECT_EQ(updatePixel(z, 1.0, 0.37, paper).log_ratio, 0.0) << "z = " << z;
  }
}

}  // namespace
}  // namespace depth_object_tracker
