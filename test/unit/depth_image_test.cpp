// SPDX-License-Identifier: BSD-3-Clause
// Depth views: both pixel types, both byte orders, padded rows, and what counts as no reading.
#include "depth_object_tracker/geometry/depth_image.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace depth_object_tracker {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Rows of pixels behind each other, each followed by `padding` bytes of 0xEE, at an odd address if `shift` is odd.
template <typename Pixel>
class ImageMemory {
 public:
  ImageMemory(const std::vector<std::vector<Pixel>>& rows, std::size_t padding, bool swap_bytes, std::size_t shift = 0)
      : shift_(shift) {
    step_ = rows[0].size() * sizeof(Pixel) + padding;
    bytes_.assign(shift + rows.size() * step_, 0xEE);
    for (std::size_t row = 0; row < rows.size(); ++row) {
      for (std::size_t col = 0; col < rows[row].size(); ++col) {
        std::uint8_t* target = bytes_.data() + shift + row * step_ + col * sizeof(Pixel);
        std::memcpy(target, &rows[row][col], sizeof(Pixel));
        if (swap_bytes) std::reverse(target, target + sizeof(Pixel));
      }
    }
    view_.width = static_cast<int>(rows[0].size());
    view_.height = static_cast<int>(rows.size());
    view_.swap_bytes = swap_bytes;
  }
  DepthImageView view(DepthImageView::PixelType type, float unit_m) {
    view_.data = bytes_.data() + shift_;
    view_.step = step_;
    view_.pixel_type = type;
    view_.unit_m = unit_m;
    return view_;
  }

 private:
  std::size_t shift_;
  std::size_t step_;
  std::vector<std::uint8_t> bytes_;
  DepthImageView view_;
};

class DepthImageLayout : public testing::TestWithParam<std::tuple<std::size_t, bool, std::size_t>> {};

TEST_P(DepthImageLayout, Reads16Bit) {
  const auto [padding, swap_bytes, shift] = GetParam();
  ImageMemory<std::uint16_t> memory({{0, 1, 258}, {1000, 32768, 65535}}, padding, swap_bytes, shift);
  const DepthImageView view = memory.view(DepthImageView::PixelType::kUint16, 0.001f);
  EXPECT_TRUE(std::isnan(view.at(0, 0)));
  EXPECT_FLOAT_EQ(view.at(0, 1), 0.001f);
  EXPECT_FLOAT_EQ(view.at(0, 2), 0.258f);
  EXPECT_FLOAT_EQ(view.at(1, 0), 1.0f);
  EXPECT_FLOAT_EQ(view.at(1, 1), 32.768f);
  EXPECT_FLOAT_EQ(view.at(1, 2), 65.535f);
}

TEST_P(DepthImageLayout, ReadsFloat) {
  const auto [padding, swap_bytes, shift] = GetParam();
  ImageMemory<float> memory({{0.0f, 0.5f, kNan}, {kInfinity, -kInfinity, -1.0f}, {3.25f, -0.0f, 1e-30f}}, padding,
                            swap_bytes, shift);
  const DepthImageView view = memory.view(DepthImageView::PixelType::kFloat32, 1.0f);
  EXPECT_FLOAT_EQ(view.at(0, 1), 0.5f);
  EXPECT_FLOAT_EQ(view.at(2, 0), 3.25f);
  EXPECT_GT(view.at(2, 2), 0.0f);
  for (const auto& [row, col] : {std::pair{0, 0}, {0, 2}, {1, 0}, {1, 1}, {1, 2}, {2, 1}}) {
    EXPECT_TRUE(std::isnan(view.at(row, col))) << row << "," << col;
  }
}

INSTANTIATE_TEST_SUITE_P(Layouts, DepthImageLayout,
                         testing::Combine(testing::Values(0u, 1u, 6u), testing::Bool(), testing::Values(0u, 1u)));

TEST(DepthImage, UnitScalesBothTypes) {
  ImageMemory<std::uint16_t> counts({{5000}}, 0, false);
  EXPECT_FLOAT_EQ(counts.view(DepthImageView::PixelType::kUint16, 0.0001f).at(0, 0), 0.5f);
  ImageMemory<float> reals({{500.0f}}, 0, false);
  EXPECT_FLOAT_EQ(reals.view(DepthImageView::PixelType::kFloat32, 0.001f).at(0, 0), 0.5f);
}

}  // namespace
}  // namespace depth_object_tracker
