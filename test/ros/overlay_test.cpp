// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/overlay.h"

#include "depth_messages.h"
#include "depth_object_tracker/ros/image_conversions.h"

#include <gtest/gtest.h>

#include <limits>

namespace depth_object_tracker {
namespace {

/// The object's left half visible, its right half occluded.
class OverlayTest : public testing::Test {
 protected:
  OverlayTest() : rendered_(static_cast<std::size_t>(320 * 240), 0.0f) {
    TestScene scene;
    const auto depth_m = scene.depth(testPose());
    image_ = makeFloatImage(depth_m, 320, 240);
    occlusion_.grid = makeSamplingGrid(testCamera(), 4);
    const int width = occlusion_.grid.camera.width, height = occlusion_.grid.camera.height;
    for (int cell = 0; cell < width * height; ++cell) {
      occlusion_.p_occluded.push_back(occlusion_.grid.fullCol(cell % width) < kSplitCol ? 0.0f : 1.0f);
    }
    for (std::size_t i = 0; i < depth_m.size(); ++i) {
      if (depth_m[i] < TestScene::kWallM) rendered_[i] = depth_m[i];
    }
  }

  const std::uint8_t* pixel(const sensor_msgs::Image& overlay, int row, int col) const {
    return &overlay.data[static_cast<std::size_t>(row) * overlay.step + 3 * static_cast<std::size_t>(col)];
  }

  static constexpr int kSplitCol = 174;
  sensor_msgs::ImagePtr image_;
  std::vector<float> rendered_;
  OcclusionMap occlusion_;
};

TEST_F(OverlayTest, TintsVisiblePixelsGreenAndOccludedOnesRed) {
  const auto overlay = drawOverlay(viewDepthImage(*image_).view, testCamera(), rendered_, occlusion_);
  ASSERT_EQ(overlay->encoding, "bgr8");
  ASSERT_EQ(overlay->data.size(), 320u * 240u * 3u);
  int green = 0, red = 0;
  for (int row = 0; row < 240; ++row) {
    for (int col = 0; col < 320; ++col) {
      if (rendered_[static_cast<std::size_t>(row * 320 + col)] <= 0.0f || std::abs(col - kSplitCol) < 5) continue;
      const std::uint8_t* bgr = pixel(*overlay, row, col);
      const bool is_green = bgr[1] > bgr[2];
      EXPECT_EQ(is_green, col < kSplitCol) << row << " " << col;
      (is_green ? green : red) += 1;
    }
  }
  EXPECT_GT(green, 50);
  EXPECT_GT(red, 50);
}

TEST_F(OverlayTest, OutlinesTheObjectInWhite) {
  const auto overlay = drawOverlay(viewDepthImage(*image_).view, testCamera(), rendered_, occlusion_);
  for (int row = 1; row < 239; ++row) {
    for (int col = 1; col < 319; ++col) {
      const bool is_object = rendered_[static_cast<std::size_t>(row * 320 + col)] > 0.0f;
      const bool right_is_object = rendered_[static_cast<std::size_t>(row * 320 + col + 1)] > 0.0f;
      if (is_object || !right_is_object) continue;
      for (int i = 0; i < 3; ++i) EXPECT_EQ(pixel(*overlay, row, col)[i], 255);
    }
  }
}

TEST_F(OverlayTest, DrawsDepthAloneWithoutAnObject) {
  const auto overlay = drawOverlay(viewDepthImage(*image_).view, testCamera(), {}, OcclusionMap());
  for (std::size_t i = 0; i < overlay->data.size(); i += 3) {
    EXPECT_NEAR(overlay->data[i], overlay->data[i + 2], 10) << "grey";
  }
}

TEST_F(OverlayTest, ImagesWithoutAnyReadingAreDark) {
  const auto empty = makeFloatImage(std::vector<float>(320 * 240, std::numeric_limits<float>::quiet_NaN()), 320, 240);
  const auto overlay = drawOverlay(viewDepthImage(*empty).view, testCamera(), {}, OcclusionMap());
  for (const std::uint8_t value : overlay->data) EXPECT_LT(value, 60);
}

}  // namespace
}  // namespace depth_object_tracker
