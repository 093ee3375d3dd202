// SPDX-License-Identifier: BSD-3-Clause
// The sensor model against what its parameters say, on scenes whose answer is known.
#include "depth_object_tracker/simulator/depth_sensor.h"

#include <gtest/gtest.h>

#include <cmath>

namespace depth_object_tracker {
namespace {

class DepthSensorTest : public testing::Test {
 protected:
  DepthSensorTest() { config_.blobs = 0; }

  std::vector<float> plane(float depth_m) const {
    return std::vector<float>(static_cast<std::size_t>(camera_.width) * static_cast<std::size_t>(camera_.height),
                              depth_m);
  }

  std::vector<std::uint16_t> measure(const std::vector<float>& depth, std::uint64_t frame = 0) const {
    DepthSensor sensor(config_, camera_, 3);
    std::vector<std::uint16_t> image(depth.size());
    sensor.measure(depth, frame, image.data());
    return image;
  }

  std::size_t index(int row, int col) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(camera_.width) + static_cast<std::size_t>(col);
  }

  DepthSensorConfig config_;
  PinholeCamera camera_{640, 480, 525.0, 525.0, 319.5, 239.5};
};

TEST_F(DepthSensorTest, PlaneHasTheNoiseOfTheModelAndNoBias) {
  for (const float depth : {0.6f, 1.0f, 2.0f}) {
    // Slightly tilted: at one depth alone the noise depends on where between two disparity steps, and two millimetres,
    // it lies.
    std::vector<float> tilted = plane(depth);
    for (std::size_t i = 0; i < tilted.size(); ++i) {
      tilted[i] += 1e-4f * static_cast<float>(i % static_cast<std::size_t>(camera_.width));
    }
    const auto image = measure(tilted);
    double sum = 0.0, square = 0.0, model = 0.0;
    for (std::size_t i = 0; i < image.size(); ++i) {
      ASSERT_GT(image[i], 0);
      const double z = static_cast<double>(tilted[i]), error = image[i] / 1000.0 - z;
      const double beyond = z - config_.noise_nearest_m;
      const double noise = config_.noise_at_nearest_m + config_.noise_growth_per_m * beyond * beyond;
      const double step = z * z * config_.disparity_step_px / (camera_.fx * config_.baseline_m);
      sum += error;
      square += error * error;
      model += noise * noise + step * step / 12.0 + 1e-6 / 12.0;
    }
    const auto count = static_cast<double>(image.size());
    EXPECT_NEAR(sum / count, 0.0, 0.1 * std::sqrt(model / count));
    EXPECT_NEAR(std::sqrt(square / model), 1.0, 0.06) << "at " << depth;
  }
}

TEST_F(DepthSensorTest, ReadingsAreDisparitySteps) {
  const double steps_metres = camera_.fx * config_.baseline_m / config_.disparity_step_px;
  for (const std::uint16_t value : measure(plane(1.5f))) {
    const double steps = std::round(steps_metres / (value / 1000.0));
    ASSERT_NEAR(value, 1000.0 * steps_metres / steps, 0.51);
  }
}

TEST_F(DepthSensorTest, OutOfRangeGivesNoReading) {
  for (const float depth : {0.3f, 8.0f, 20.0f}) {
    for (const std::uint16_t value : measure(plane(depth))) ASSERT_EQ(value, 0);
  }
}

TEST_F(DepthSensorTest, NearBoardThrowsAShadowToItsLeft) {
  config_.edge_jitter_px = 0.0;
  std::vector<float> depth = plane(1.6f);
  const int left = 300, right = 400;
  for (int row = 0; row < camera_.height; ++row) {
    for (int col = left; col < right; ++col) depth[index(row, col)] = 0.8f;
  }
  const auto image = measure(depth);
  const double shadow_px = camera_.fx * config_.baseline_m * (1.0 / 0.8 - 1.0 / 1.6);
  const int row = 200, middle = left - static_cast<int>(shadow_px / 2);
  EXPECT_EQ(image[index(row, middle)], 0) << "in the shadow";
  EXPECT_GT(image[index(row, left - static_cast<int>(shadow_px) - 5)], 0) << "left of the shadow";
  EXPECT_GT(image[index(row, right + 5)], 0) << "right of the board there is no shadow";
  EXPECT_GT(image[index(row, (left + right) / 2)], 0) << "on the board";
}

TEST_F(DepthSensorTest, SurfacesSeenFlatLoseReadings) {
  std::vector<float> depth = plane(1.0f);
  // A floor falling away by 10 mm a pixel at 1 m: seen at 79 degrees from its normal.
  for (int row = 0; row < camera_.height; ++row) {
    for (int col = 0; col < camera_.width; ++col) depth[index(row, col)] = 1.0f + 0.01f * static_cast<float>(row % 60);
  }
  const auto image = measure(depth);
  int holes = 0, count = 0;
  for (int row = 5; row < 55; ++row) {
    for (int col = 100; col < 500; ++col, ++count) holes += image[index(row, col)] == 0 ? 1 : 0;
  }
  EXPECT_GT(holes, count / 10);
  EXPECT_LT(holes, count);
}

TEST_F(DepthSensorTest, FramesDifferButCanBeRepeated) {
  EXPECT_EQ(measure(plane(1.0f), 7), measure(plane(1.0f), 7));
  EXPECT_NE(measure(plane(1.0f), 7), measure(plane(1.0f), 8));
}

}  // namespace
}  // namespace depth_object_tracker
