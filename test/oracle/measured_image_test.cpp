// SPDX-License-Identifier: BSD-3-Clause
// The single-precision pixel ratios of the hot loop against the double-precision reference.
#include "depth_object_tracker/model/measured_image.h"

#include "depth_object_tracker/model/pixel_likelihood.h"
#include "millimetre_view.h"

#include <gtest/gtest.h>

#include <limits>

namespace depth_object_tracker {
namespace {

/// A row of float readings as a MeasuredImage sees them.
class RowImage {
 public:
  /// @param taken surfaces of other things that are seen; empty = none.
  RowImage(std::vector<float> readings, const PixelModelConfig& config, const std::vector<float>& taken = {})
      : readings_(std::move(readings)), image_(config) {
    PinholeCamera camera;
    camera.width = static_cast<int>(readings_.size());
    camera.height = 1;
    camera.fx = camera.fy = 100.0;
    view_.data = reinterpret_cast<const std::uint8_t*>(readings_.data());
    view_.width = camera.width;
    view_.height = 1;
    view_.step = readings_.size() * sizeof(float);
    view_.pixel_type = DepthImageView::PixelType::kFloat32;
    view_.unit_m = 1.0f;
    grid_ = makeSamplingGrid(camera, 1);
    image_.setImage(view_, grid_);
    image_.setTakenSurfaces(taken);
    image_.prepare(image_.imageBox());
  }

  void setOccluders(const std::vector<float>& depth_m) {
    image_.setImage(view_, grid_);
    image_.setOccluders(depth_m);
    image_.prepare(image_.imageBox());
  }

  MeasuredPixel pixel(int col) const { return image_.pixel(0, col); }
  PixelRatios ratios(int col, float rendered_depth_m) const {
    return pixelRatios(image_.model(), pixel(col), rendered_depth_m);
  }
  float believedOcclusion(float p_occluded, int col, float rendered_depth_m) const {
    return depth_object_tracker::believedOcclusion(image_.model(), p_occluded, pixel(col), rendered_depth_m);
  }

 private:
  std::vector<float> readings_;
  DepthImageView view_;
  SamplingGrid grid_;
  MeasuredImage image_;
};

class WithModel : public testing::TestWithParam<OccluderModel> {
 protected:
  WithModel() { config_.occluder_model = GetParam(); }
  PixelModelConfig config_;
};
INSTANTIATE_TEST_SUITE_P(Ratios, WithModel, testing::Values(OccluderModel::kConsistent, OccluderModel::kPaper));

TEST_P(WithModel, RatiosEqualTheReference) {
  std::vector<float> readings;
  for (float z = 0.2f; z < 6.0f; z += 0.0713f) readings.push_back(z);
  const RowImage row(readings, config_);
  double worst = 0.0;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const double z = readings[i];
    const double stddev = surfaceNoiseStddev(z, config_), miss = missDensity(z, config_);
    for (double t = -12.0; t <= 12.0; t += 0.0937) {
      const auto d = static_cast<float>(z + t * stddev);
      if (d <= 0.05f) continue;
      const PixelRatios ratios = row.ratios(static_cast<int>(i), d);
      const double visible = visibleDensity(z, d, config_) / miss, occluded = occludedDensity(z, d, config_) / miss;
      worst = std::max(
          {worst, std::abs(std::log(ratios.visible / visible)), std::abs(std::log(ratios.occluded / occluded))});
      ASSERT_NEAR(std::log(ratios.visible / visible), 0.0, 1e-3) << "z = " << z << ", d = " << d;
      ASSERT_NEAR(std::log(ratios.occluded / occluded), 0.0, 1e-3) << "z = " << z << ", d = " << d;
      const double tail = config_.tail_weight / config_.max_depth_m / miss;
      ASSERT_NEAR(ratios.surface, visible - tail, 1e-3 * visible) << "z = " << z << ", d = " << d;
    }
  }
  std::printf("largest deviation of the ratios: %.2e nat\n", worst);
}

TEST_P(WithModel, RatiosEqualTheReferenceFarFromTheReading) {
  const std::vector<float> readings = {0.3f, 0.6f, 1.0f, 2.0f, 4.0f, 5.99f, 6.0f};
  const RowImage row(readings, config_);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    for (const float d : {0.06f, 0.2f, 0.5f, 1.1f, 2.5f, 5.0f, 9.0f}) {
      const double z = readings[i], miss = missDensity(z, config_);
      const PixelRatios ratios = row.ratios(static_cast<int>(i), d);
      EXPECT_NEAR(ratios.visible, visibleDensity(z, d, config_) / miss,
                  1e-3 * visibleDensity(z, d, config_) / miss + 1e-12);
      EXPECT_NEAR(ratios.occluded, occludedDensity(z, d, config_) / miss,
                  1e-3 * occludedDensity(z, d, config_) / miss + 1e-12);
    }
  }
}

TEST(MeasuredImage, ReadingsFarInFrontCountAsOccludedAtLeastHalf) {
  PixelModelConfig config;
  config.min_p_occluded_in_front = 0.5;
  const RowImage row({1.0f}, config);
  const auto stddev = static_cast<float>(surfaceNoiseStddev(1.0, config));
  for (const float p : {0.0f, 0.1f, 0.25f, 0.5f, 0.9f, 1.0f}) {
    float last = p;
    for (float t = -20.0f; t < 60.0f; t += 0.25f) {
      const float believed = row.believedOcclusion(p, 0, 1.0f + t * stddev);
      ASSERT_GE(believed, last - 1e-6f) << "the farther in front, the more";
      if (t <= 1.0f) {
        ASSERT_NEAR(believed, p, 1e-2f) << "readings on or behind the surface are left alone";
      }
      last = believed;
    }
    EXPECT_NEAR(last, std::max(p, 0.5f), 1e-6f);
  }
  config.min_p_occluded_in_front = 0.0;
  EXPECT_EQ(RowImage({1.0f}, config).believedOcclusion(0.1f, 0, 2.0f), 0.1f) << "0 turns it off";
}

TEST(MeasuredImage, WhatIsBehindAKnownOccluderCountsAsOccludedRatherThanNot) {
  PixelModelConfig config;
  config.known_occluder_p_occluded = 0.7;
  config.known_occluder_margin_m = 0.03;
  config.min_p_occluded_in_front = 0.0;
  RowImage row({0.0f, 0.9f, 0.9f}, config);
  row.setOccluders({0.9f, 0.9f, 0.0f});
  EXPECT_EQ(row.believedOcclusion(0.1f, 0, 1.0f), 0.7f) << "no reading contradicts it";
  EXPECT_EQ(row.believedOcclusion(0.1f, 1, 1.0f), 0.7f);
  EXPECT_EQ(row.believedOcclusion(0.9f, 1, 1.0f), 0.9f) << "who knows better is not contradicted";
  EXPECT_EQ(row.believedOcclusion(0.1f, 1, 0.92f), 0.1f) << "too near to it to say";
  EXPECT_EQ(row.believedOcclusion(0.1f, 1, 0.85f), 0.1f) << "before it";
  EXPECT_EQ(row.believedOcclusion(0.1f, 2, 1.0f), 0.1f) << "there is none in this pixel";
  row.setOccluders({0.9f});
  EXPECT_EQ(row.believedOcclusion(0.1f, 1, 1.0f), 0.1f) << "of another size than the grid";
  config.known_occluder_p_occluded = 0.0;
  RowImage off({0.0f, 0.9f, 0.9f}, config);
  off.setOccluders({0.9f, 0.9f, 0.0f});
  EXPECT_EQ(off.believedOcclusion(0.1f, 1, 1.0f), 0.1f);
}

// A robot's links are drawn centimetres off: where the object is seen behind one, it is as if there were none.
TEST(MeasuredImage, AnOccluderThatIsSeenThroughDoesNotCount) {
  PixelModelConfig config;
  config.known_occluder_p_occluded = 0.95;
  config.known_occluder_margin_m = 0.03;
  RowImage row({1.0f, 0.94f, 0.92f, 0.7f}, config);
  row.setOccluders({0.9f, 0.9f, 0.9f, 0.9f});
  EXPECT_EQ(row.believedOcclusion(0.1f, 0, 1.0f), 0.1f) << "the object is seen";
  EXPECT_EQ(row.believedOcclusion(0.1f, 1, 0.94f), 0.1f);
  EXPECT_EQ(row.pixel(1).occluder_limit, kNoOccluder);
  EXPECT_EQ(row.believedOcclusion(0.1f, 2, 1.0f), 0.95f) << "as near as its place is known";
  EXPECT_EQ(row.believedOcclusion(0.1f, 3, 1.0f), 0.95f) << "what is nearer still does not contradict it";
}

TEST(MeasuredImage, AReadingOnSomethingElsesSurfaceIsNotTheObjects) {
  const PixelModelConfig config;
  const RowImage free({1.0f, 1.0f, 1.0f}, config), taken({1.0f, 1.0f, 1.0f}, config, {1.003f, 1.1f, 0.0f});
  EXPECT_EQ(taken.pixel(0).visible_peak, 0.0f);
  EXPECT_EQ(taken.ratios(0, 1.0f).surface, 0.0f);
  EXPECT_LT(taken.ratios(0, 1.0f).visible, 0.1f) << "no reward for an object in the same place";
  EXPECT_NEAR(taken.ratios(0, 1.2f).occluded, free.ratios(0, 1.2f).occluded, 1e-6f) << "behind it: occluded as ever";
  EXPECT_NEAR(taken.ratios(0, 0.8f).visible, free.ratios(0, 0.8f).visible, 1e-6f) << "before it: seen through as ever";
  for (const int col : {1, 2}) EXPECT_EQ(taken.pixel(col).visible_peak, free.pixel(col).visible_peak);
}

TEST(MeasuredImage, TheFloorOfTheBeliefRisesOverItsRamp) {
  PixelModelConfig config;
  config.min_p_occluded_in_front = 0.5;
  const RowImage row({1.0f}, config);
  const auto stddev = static_cast<float>(surfaceNoiseStddev(1.0, config));
  const auto floorAt = [&](float t) { return row.believedOcclusion(0.0f, 0, 1.0f + t * stddev); };
  EXPECT_EQ(floorAt(kInFrontBegin - 0.01f), 0.0f);
  EXPECT_GT(floorAt(kInFrontBegin + 0.1f), 0.0f);
  EXPECT_NEAR(floorAt(0.5f * (kInFrontBegin + kInFrontEnd)), 0.25f, 1e-4f);
  EXPECT_LT(floorAt(kInFrontEnd - 0.1f), 0.5f);
  EXPECT_EQ(floorAt(kInFrontEnd + 0.01f), 0.5f);
}

TEST(MeasuredImage, ReadingsWithoutInformationAreMarked) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  PixelModelConfig config;
  config.no_reading_ratio = 1.0;
  const RowImage row({0.0f, nan, infinity, -infinity, -0.5f, 6.01f, 1e9f, 5.99f, 1.0f}, config);
  for (int col = 0; col < 7; ++col) EXPECT_EQ(row.pixel(col).depth, 0.0f) << "column " << col;
  EXPECT_EQ(row.pixel(7).depth, 5.99f);
  EXPECT_EQ(row.pixel(8).depth, 1.0f);
}

TEST(MeasuredImage, WithoutAReadingRatiosAreTheSameAtAnyDepth) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  PixelModelConfig config;
  config.no_reading_ratio = 0.25;
  const RowImage row({nan, 0.0f, 7.0f, 1.0f}, config);
  const PixelModel model = MeasuredImage(config).model();
  for (int col = 0; col < 3; ++col) {
    EXPECT_FALSE(row.pixel(col).hasReading()) << "column " << col;
    for (const float depth : {0.2f, 1.0f, 5.0f}) {
      const PixelRatios ratios = pixelRatios(model, row.pixel(col), depth);
      EXPECT_NEAR(ratios.visible, 0.25f, 1e-4f);
      EXPECT_NEAR(ratios.occluded, 1.0f, 1e-3f);
      EXPECT_EQ(ratios.surface, 0.0f);
      EXPECT_EQ(believedOcclusion(model, 0.3f, row.pixel(col), depth), 0.3f) << "nothing is seen in front";
    }
  }
  EXPECT_TRUE(row.pixel(3).hasReading());
}

TEST(MeasuredImage, ReadsOnlyTheBoxesAskedForAndKeepsThem) {
  PinholeCamera camera;
  camera.width = 30;
  camera.height = 27;
  camera.fx = camera.fy = 10.0;
  std::vector<std::uint16_t> counts(30 * 27);
  for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = static_cast<std::uint16_t>(500 + i);
  DepthImageView view;
  view.data = reinterpret_cast<const std::uint8_t*>(counts.data());
  view.width = 30;
  view.height = 27;
  view.step = 60;
  MeasuredImage image((PixelModelConfig()));
  image.setImage(view, makeSamplingGrid(camera, 1));
  const CellBox first{9, 12, 17, 20}, second{17, 20, 2, 5};  // in tiles that do not touch
  EXPECT_FALSE(image.isPrepared(first));
  image.prepare(first);
  EXPECT_TRUE(image.isPrepared(first));
  EXPECT_TRUE(image.isPrepared({8, 16, 16, 24})) << "whole tiles are";
  EXPECT_FALSE(image.isPrepared({8, 16, 15, 24})) << "and nothing beyond";
  EXPECT_FALSE(image.isPrepared(second));
  EXPECT_TRUE(image.isPrepared({-5, -1, 0, 3})) << "cells outside of the image are never needed";
  image.prepare(second);
  for (int row = 9; row < 20; ++row) {
    for (int col = 2; col < 20; ++col)
      EXPECT_FLOAT_EQ(image.pixel(row, col).depth, 0.001f * static_cast<float>(500 + 30 * row + col));
  }
  counts[30 * 11 + 18] = 4000;
  counts[30 * 26 + 29] = 3000;
  image.prepare({0, 27, 0, 30});
  EXPECT_FLOAT_EQ(image.pixel(11, 18).depth, 0.001f * (500 + 30 * 11 + 18)) << "a pixel is read once a frame";
  EXPECT_FLOAT_EQ(image.pixel(26, 29).depth, 3.0f) << "and not before it is asked for";
  EXPECT_FLOAT_EQ(image.pixel(26, 28).depth, 0.001f * (500 + 30 * 26 + 28));
  image.setImage(view, makeSamplingGrid(camera, 1));
  image.prepare(first);
  EXPECT_FLOAT_EQ(image.pixel(11, 18).depth, 4.0f) << "a new frame is read anew";
  EXPECT_EQ(image.source(), view.data);
}

class AfterPreparing : public testing::Test {
 protected:
  AfterPreparing() : image_((PixelModelConfig())) {
    camera_.width = 16;
    camera_.height = 8;
    camera_.fx = camera_.fy = 10.0;
    counts_[kMissing] = 0;
    image_.setImage(viewOf(counts_, camera_), makeSamplingGrid(camera_, 1));
    image_.prepare(image_.imageBox());
  }

  static constexpr std::size_t kMissing = 5;
  PinholeCamera camera_;
  std::vector<std::uint16_t> counts_ = std::vector<std::uint16_t>(16 * 8, 1000);
  MeasuredImage image_;
};

TEST_F(AfterPreparing, WhatIsTakenIsStillSetAside) {
  ASSERT_GT(image_.pixel(3, 3).visible_peak, 0.0f);
  image_.setTakenSurfaces(std::vector<float>(16 * 8, 1.0f));
  image_.prepare(image_.imageBox());
  EXPECT_EQ(image_.pixel(3, 3).visible_peak, 0.0f);
}

TEST_F(AfterPreparing, KnownOccludersStillCount) {
  ASSERT_EQ(image_.pixel(3, 3).occluder_limit, kNoOccluder);
  image_.setOccluders(std::vector<float>(16 * 8, 1.0f));
  image_.prepare(image_.imageBox());
  EXPECT_LT(image_.pixel(3, 3).occluder_limit, 1.1f);
}

TEST_F(AfterPreparing, MissingReadingsAreWeighedAnew) {
  image_.setMissingRatio(0.6f);
  EXPECT_EQ(image_.pixel(0, kMissing).tail, 0.6f);
  EXPECT_EQ(image_.pixel(0, kMissing).depth, kMissingReadingM);
  EXPECT_EQ(image_.pixel(0, kMissing + 1).depth, 1.0f);
  image_.setMissingRatio(1.0f);
  EXPECT_EQ(image_.pixel(0, kMissing).depth, 0.0f) << "says nothing";
}

TEST(MeasuredImage, SubSampledCellsAreThePixelsOfTheGrid) {
  PinholeCamera camera;
  camera.width = 20;
  camera.height = 15;
  camera.fx = camera.fy = 10.0;
  std::vector<std::uint16_t> counts(20 * 15);
  for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = static_cast<std::uint16_t>(500 + i);
  DepthImageView view;
  view.data = reinterpret_cast<const std::uint8_t*>(counts.data());
  view.width = 20;
  view.height = 15;
  view.step = 40;
  for (const int factor : {2, 3, 5}) {
    const SamplingGrid grid = makeSamplingGrid(camera, factor);
    MeasuredImage image((PixelModelConfig()));
    image.setImage(view, grid);
    image.prepare(image.imageBox());
    for (int row = 0; row < grid.camera.height; ++row) {
      for (int col = 0; col < grid.camera.width; ++col) {
        EXPECT_FLOAT_EQ(image.pixel(row, col).depth,
                        0.001f * static_cast<float>(500 + 20 * grid.fullRow(row) + grid.fullCol(col)));
      }
    }
  }
}

TEST(MeasuredImage, ValidFractionCountsReadingsInRange) {
  PinholeCamera camera;
  camera.width = 80;
  camera.height = 40;
  camera.fx = camera.fy = 10.0;
  std::vector<std::uint16_t> counts(80 * 40, 1000);
  for (int row = 0; row < 40; ++row) {
    for (int col = 0; col < 20; ++col) counts[static_cast<std::size_t>(80 * row + col)] = row % 2 == 0 ? 0 : 9000;
  }
  DepthImageView view;
  view.data = reinterpret_cast<const std::uint8_t*>(counts.data());
  view.width = 80;
  view.height = 40;
  view.step = 160;
  MeasuredImage image((PixelModelConfig()));
  image.setImage(view, makeSamplingGrid(camera, 2));
  EXPECT_NEAR(image.validFraction(), 0.75, 1e-9);
}

}  // namespace
}  // namespace depth_object_tracker
