// SPDX-License-Identifier: BSD-3-Clause
// Occlusion posterior and likelihood per particle against the sum over every history of every pixel's occlusion.
#include "depth_object_tracker/filter/depth_likelihood.h"
#include "depth_object_tracker/model/pixel_likelihood.h"

#include "plate_scene.h"

#include <gtest/gtest.h>
#include <unsupported/Eigen/MatrixFunctions>

#include <cmath>
#include <limits>

namespace depth_object_tracker {
namespace {

constexpr int kPixels = 3;
constexpr float kHalfWidth = 0.15f;  // at 1 m the three beams meet the plate's plane at x = -0.1, 0, 0.1
const float kNone = std::numeric_limits<float>::quiet_NaN();

struct TestFrame {
  double dt_s;
  std::vector<float> readings;
};

/// A past of one particle: where its plate stands in every frame.
using Past = std::vector<Pose>;

const std::vector<TestFrame> kFrames = {{0.0, {1.001f, 0.70f, 1.003f}},
                                        {1.0 / 30.0, {0.998f, 0.72f, 0.80f}},
                                        {0.5, {1.30f, kNone, 0.81f}},
                                        {0.1, {1.002f, 1.004f, 1.015f}}};
// The first stays; the second starts farther away, misses the first pixel once, and comes back.
const Past kSteadyPast = {poseAt(0, 0, 1.0), poseAt(0, 0, 1.0), poseAt(0, 0, 1.002), poseAt(0, 0, 1.0)};
const Past kOtherPast = {poseAt(0, 0, 1.02), poseAt(0.12, 0, 1.01), poseAt(0, 0, 0.99), poseAt(0, 0, 1.005)};

bool covers(const Pose& pose, int pixel) {
  const double x = (pixel - 1) * 0.1 * pose.translation().z();
  return std::abs(x - pose.translation().x()) < kHalfWidth;
}

/// Sums the joint probability of readings and occlusion over all 2^(pixels * frames) histories.
class BruteForce {
 public:
  BruteForce(const PixelModelConfig& pixel, const OcclusionChainConfig& chain) : pixel_(pixel), chain_(chain) {}

  struct Result {
    double log_evidence = 0.0;  // of all readings so far, against "no object"
    double p_occluded[kPixels] = {};
  };

  Result sum(const Past& past, int num_frames) const {
    Result result;
    double total = 0.0;
    const int bits = kPixels * num_frames;
    for (unsigned history = 0; history < (1u << bits); ++history) {
      double probability = 1.0;
      for (int i = 0; i < kPixels; ++i)
        probability *= historyProbability(past, num_frames, i, history >> (i * num_frames));
      total += probability;
      for (int i = 0; i < kPixels; ++i) {
        if (history >> (i * num_frames + num_frames - 1) & 1u) result.p_occluded[i] += probability;
      }
    }
    for (double& p : result.p_occluded) p /= total;
    result.log_evidence = std::log(total);
    return result;
  }

 private:
  // p(o_1..o_T, z_1..z_T) / p(z_1..z_T | no object) of one pixel; bit k of `states` is o in frame k.
  double historyProbability(const Past& past, int num_frames, int pixel, unsigned states) const {
    double probability = 1.0;
    for (int k = 0; k < num_frames; ++k) {
      const int now = states >> k & 1u;
      if (k == 0) {
        probability *= now == 1 ? chain_.initial_p_occluded : 1.0 - chain_.initial_p_occluded;
      } else {
        probability *=
            transition(kFrames[static_cast<std::size_t>(k)].dt_s)(now, static_cast<int>(states >> (k - 1) & 1u));
      }
      probability *=
          densityRatio(past[static_cast<std::size_t>(k)],
                       kFrames[static_cast<std::size_t>(k)].readings[static_cast<std::size_t>(pixel)], pixel, now == 1);
    }
    return probability;
  }

  double densityRatio(const Pose& pose, float reading, int pixel, bool occluded) const {
    if (!covers(pose, pixel)) return 1.0;
    if (!(reading > 0.0f)) {
      return occluded || pixel_.occluder_model == OccluderModel::kPaper ? 1.0 : pixel_.no_reading_ratio;
    }
    const double d = pose.translation().z();
    const double density = occluded ? occludedDensity(reading, d, pixel_) : visibleDensity(reading, d, pixel_);
    return density / missDensity(reading, pixel_);
  }

  // Column: from visible, occluded; row: to. The one-second matrix to the power of dt, by its eigenvalues.
  Eigen::Matrix2d transition(double dt_s) const {
    Eigen::Matrix2d one_second;
    one_second << chain_.p_visible_given_visible, chain_.p_visible_given_occluded, 1.0 - chain_.p_visible_given_visible,
        1.0 - chain_.p_visible_given_occluded;
    return one_second.pow(dt_s);
  }

  PixelModelConfig pixel_;
  OcclusionChainConfig chain_;
};

class OcclusionPosterior : public testing::TestWithParam<OccluderModel> {
 protected:
  OcclusionPosterior() : grid_(makeSamplingGrid(makeCamera(kPixels, 1, 10.0), 1)) {
    pixel_.occluder_model = GetParam();
    pixel_.edge_stddev_px = 0.0;
    pixel_.min_p_occluded_in_front = 0.0;
    chain_.initial_p_occluded = 0.4;  // not the stationary value: the first step of the chain must show
    likelihood_.emplace(makePlate(kHalfWidth), Eigen::Vector3d::Zero(), pixel_, chain_, 2, 1);
  }

  /// Poses of all particles in a frame.
  std::vector<double> updateFrame(std::size_t k, const std::vector<Pose>& poses) {
    likelihood_->setImage(viewOf(kFrames[k].readings, grid_.camera), grid_, kFrames[k].dt_s);
    likelihood_->prepare(poses);
    std::vector<double> log_likelihoods;
    likelihood_->update(poses, log_likelihoods);
    return log_likelihoods;
  }

  /// A particle's stored values of the tile that holds a cell; nullptr = it never measured there.
  const float* tileOf(int particle, int row, int col) {
    const OcclusionTiles& memory = likelihood_->memory();
    return memory.tile(particle, row / kTileSize * memory.tileCols() + col / kTileSize);
  }

  double belief(int particle, int row, int col) {
    const OcclusionTiles& memory = likelihood_->memory();
    const float* tile = tileOf(particle, row, col);
    return memory.probability(tile != nullptr ? tile[row % kTileSize * kTileSize + col % kTileSize]
                                              : memory.unmeasured());
  }
  double belief(int particle, int pixel) { return belief(particle, 0, pixel); }

  void expectBeliefs(int particle, const BruteForce::Result& expected, std::size_t frame) {
    for (int i = 0; i < kPixels; ++i) {
      EXPECT_NEAR(belief(particle, i), expected.p_occluded[i], 1e-4)
          << "particle " << particle << ", pixel " << i << ", frame " << frame;
    }
  }

  SamplingGrid grid_;
  PixelModelConfig pixel_;
  OcclusionChainConfig chain_;
  std::optional<DepthLikelihood> likelihood_;
};
INSTANTIATE_TEST_SUITE_P(Models, OcclusionPosterior,
                         testing::Values(OccluderModel::kConsistent, OccluderModel::kPaper));

TEST_P(OcclusionPosterior, EqualsTheSumOverAllHistoriesForTwoPasts) {
  const BruteForce brute_force(pixel_, chain_);
  const Past* pasts[] = {&kSteadyPast, &kOtherPast};
  double evidence[] = {0.0, 0.0};
  double largest_disagreement = 0.0;
  for (std::size_t k = 0; k < kFrames.size(); ++k) {
    const std::vector<double> log_likelihoods = updateFrame(k, {kSteadyPast[k], kOtherPast[k]});
    for (int particle = 0; particle < 2; ++particle) {
      const BruteForce::Result expected = brute_force.sum(*pasts[particle], static_cast<int>(k) + 1);
      EXPECT_NEAR(log_likelihoods[static_cast<std::size_t>(particle)], expected.log_evidence - evidence[particle], 1e-4)
          << "frame " << k;
      evidence[particle] = expected.log_evidence;
      expectBeliefs(particle, expected, k);
    }
    for (int i = 0; i < kPixels; ++i)
      largest_disagreement = std::max(largest_disagreement, std::abs(belief(0, i) - belief(1, i)));
  }
  EXPECT_GT(largest_disagreement, 0.5) << "the two pasts must believe different things, else this test shows little";
}

TEST_P(OcclusionPosterior, DescendantsContinueTheirAncestorsPast) {
  const BruteForce brute_force(pixel_, chain_);
  for (std::size_t k = 0; k < 2; ++k) updateFrame(k, {kSteadyPast[k], kOtherPast[k]});
  likelihood_->resample({1, 1});
  for (std::size_t k = 2; k < kFrames.size(); ++k) updateFrame(k, {kSteadyPast[k], kOtherPast[k]});
  Past grafted = kSteadyPast;
  std::copy_n(kOtherPast.begin(), 2, grafted.begin());
  const int all = static_cast<int>(kFrames.size());
  expectBeliefs(0, brute_force.sum(grafted, all), kFrames.size() - 1);
  expectBeliefs(1, brute_force.sum(kOtherPast, all), kFrames.size() - 1);
}

TEST_P(OcclusionPosterior, IsRememberedByAFilterThatOnlyWeighsParticles) {
  // The paper's proposal never looks at the image before particles are weighed: update() alone must remember.
  const BruteForce brute_force(pixel_, chain_);
  std::vector<double> log_likelihoods;
  for (std::size_t k = 0; k < kFrames.size(); ++k) {
    likelihood_->setImage(viewOf(kFrames[k].readings, grid_.camera), grid_, kFrames[k].dt_s);
    likelihood_->update({kSteadyPast[k], kOtherPast[k]}, log_likelihoods);
  }
  const int all = static_cast<int>(kFrames.size());
  const double last =
      brute_force.sum(kSteadyPast, all).log_evidence - brute_force.sum(kSteadyPast, all - 1).log_evidence;
  EXPECT_NEAR(log_likelihoods[0], last, 1e-4);
  for (int i = 0; i < 2; ++i) ASSERT_NE(tileOf(i, 0, 0), nullptr) << "particle " << i;
  expectBeliefs(0, brute_force.sum(kSteadyPast, all), kFrames.size() - 1);
  expectBeliefs(1, brute_force.sum(kOtherPast, all), kFrames.size() - 1);
}

TEST_P(OcclusionPosterior, MeanBeliefIsTheWeightedMeanOverParticles) {
  for (std::size_t k = 0; k < 3; ++k) updateFrame(k, {kSteadyPast[k], kOtherPast[k]});
  const double steady_weight = 0.3;
  likelihood_->setWeights({steady_weight, 1.0 - steady_weight});
  likelihood_->setImage(viewOf(kFrames[3].readings, grid_.camera), grid_, kFrames[3].dt_s);
  likelihood_->prepare({kSteadyPast[3], kOtherPast[3]});
  double expected = 0.0;
  for (int i = 0; i < kPixels; ++i) {
    const double p_occluded = steady_weight * belief(0, i) + (1.0 - steady_weight) * belief(1, i);
    expected += updatePixel(kFrames[3].readings[static_cast<std::size_t>(i)], 1.0, p_occluded, pixel_).log_ratio;
  }
  EXPECT_NEAR(likelihood_->logLikelihood(poseAt(0, 0, 1.0), 0), expected, 1e-4);
  EXPECT_NEAR(likelihood_->assess(poseAt(0, 0, 1.0), 0).log_likelihood, expected, 1e-4);
}

TEST_P(OcclusionPosterior, AfterResamplingAllParticlesCountTheSame) {
  for (std::size_t k = 0; k < 3; ++k) updateFrame(k, {kSteadyPast[k], kOtherPast[k]});
  likelihood_->setWeights({0.9, 0.1});
  likelihood_->resample({0, 1});  // both survive; what tells them apart from now on is not their old weight
  likelihood_->setImage(viewOf(kFrames[3].readings, grid_.camera), grid_, kFrames[3].dt_s);
  likelihood_->prepare({kSteadyPast[3], kOtherPast[3]});
  double expected = 0.0;
  for (int i = 0; i < kPixels; ++i) {
    const double p_occluded = 0.5 * (belief(0, i) + belief(1, i));
    expected += updatePixel(kFrames[3].readings[static_cast<std::size_t>(i)], 1.0, p_occluded, pixel_).log_ratio;
  }
  EXPECT_NEAR(likelihood_->logLikelihood(poseAt(0, 0, 1.0), 0), expected, 1e-4);
}

TEST_P(OcclusionPosterior, ParticlesThatFlyApartAreAllRemembered) {
  // Places are added while particles are weighed; the mean belief must follow.
  SamplingGrid wide = makeSamplingGrid(makeCamera(64, 48, 60.0), 1);
  const std::vector<float> readings(64 * 48, 0.8f);
  likelihood_->setImage(viewOf(readings, wide.camera), wide, 0.0);
  likelihood_->prepare({poseAt(0, 0, 1.0), poseAt(0, 0, 1.0)});
  const std::vector<Pose> apart = {poseAt(-0.35, -0.25, 1.0), poseAt(0.35, 0.25, 1.0)};
  std::vector<double> log_likelihoods;
  likelihood_->update(apart, log_likelihoods);
  for (std::size_t i = 0; i < 2; ++i) {
    const Eigen::Vector2d pixel = wide.camera.project(apart[i].translation());
    const int row = static_cast<int>(std::lround(pixel.y())), col = static_cast<int>(std::lround(pixel.x()));
    const int particle = static_cast<int>(i);
    ASSERT_NE(tileOf(particle, row, col), nullptr) << "particle " << i;
    const double expected = updatePixel(0.8f, 1.0, chain_.initial_p_occluded, pixel_).p_occluded;
    EXPECT_NEAR(belief(particle, row, col), expected, 1e-4);
    const PoseAssessment assessment = likelihood_->assess(apart[i], 0);
    const double prior = updatePixel(0.8f, 1.0, chain_.initial_p_occluded, pixel_).log_ratio;
    EXPECT_NEAR(assessment.log_likelihood, prior * assessment.measured_pixels,
                1e-3 * std::abs(assessment.log_likelihood))
        << "the estimate is judged by the beliefs of before the measurement";
  }
}

TEST_P(OcclusionPosterior, MissingReadingsLeaveTheChainAloneWhereTheySayNothing) {
  pixel_.no_reading_ratio = 1.0;
  likelihood_.emplace(makePlate(kHalfWidth), Eigen::Vector3d::Zero(), pixel_, chain_, 2, 1);
  const std::vector<float> nothing = {kNone, 0.0f, 7.0f};
  updateFrame(0, {kSteadyPast[0], kOtherPast[0]});
  const double before = belief(0, 1);
  likelihood_->setImage(viewOf(nothing, grid_.camera), grid_, 0.25);
  likelihood_->prepare({kSteadyPast[1], kSteadyPast[1]});
  std::vector<double> log_likelihoods;
  likelihood_->update({kSteadyPast[1], kSteadyPast[1]}, log_likelihoods);
  EXPECT_EQ(log_likelihoods[0], 0.0);
  EXPECT_EQ(log_likelihoods[1], 0.0);
  EXPECT_NEAR(belief(0, 1), 0.25 + (before - 0.25) * std::pow(0.6, 0.25), 1e-6);
}

TEST_P(OcclusionPosterior, MissingReadingsSayLessTheMoreOfTheObjectHasNone) {
  const std::vector<float> nothing = {kNone, 0.0f, 7.0f}, two = {1.001f, 0.999f, kNone}, all = {1.001f, 0.999f, 1.0f};
  const auto weigh = [&](const std::vector<float>& readings) {
    likelihood_->setImage(viewOf(readings, grid_.camera), grid_, 0.25);
    likelihood_->weighMissingReadings(kSteadyPast[1]);
    return likelihood_->image().missingRatio();
  };
  const bool is_paper = GetParam() == OccluderModel::kPaper;
  const double ratio = is_paper ? 1.0 : pixel_.no_reading_ratio;
  EXPECT_NEAR(weigh(all), ratio, 1e-6);
  const double of_two = weigh(two);
  EXPECT_TRUE(is_paper ? of_two == 1.0 : of_two > ratio && of_two < 1.0) << "more than usual: " << of_two;
  EXPECT_EQ(weigh(nothing), 1.0) << "a covered lens";
  likelihood_->prepare({kSteadyPast[1]});
  EXPECT_EQ(likelihood_->logLikelihood(kSteadyPast[1], 0), 0.0);
}

TEST_P(OcclusionPosterior, APoseOutsideOfTheImageSaysNothing) {
  const std::vector<double> log_likelihoods = updateFrame(0, {poseAt(5, 0, 1), poseAt(0, 0, -1)});
  EXPECT_EQ(log_likelihoods[0], 0.0);
  EXPECT_EQ(log_likelihoods[1], 0.0);
}

TEST_P(OcclusionPosterior, MapShowsTheMeanOverCoveringParticlesOnly) {
  updateFrame(0, {kSteadyPast[0], kOtherPast[0]});
  const std::vector<double> log_likelihoods = updateFrame(1, {kSteadyPast[1], kOtherPast[1]});
  ASSERT_EQ(log_likelihoods.size(), 2u);
  std::vector<float> map;
  likelihood_->occlusionMap({kSteadyPast[1], kOtherPast[1]}, {0.6, 0.4}, map);
  ASSERT_EQ(map.size(), 3u);
  EXPECT_NEAR(map[0], belief(0, 0), 1e-6) << "the second particle does not cover the first pixel";
  EXPECT_NEAR(map[1], 0.6 * belief(0, 1) + 0.4 * belief(1, 1), 1e-6);
  likelihood_->occlusionMap({kSteadyPast[1], kOtherPast[1]}, {0.4, 0.6}, map);
  EXPECT_TRUE(std::isnan(map[0])) << "particles with less than half of the weight cover it";
}

}  // namespace
}  // namespace depth_object_tracker
