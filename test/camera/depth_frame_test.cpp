// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/camera/depth_frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace depth_object_tracker {
namespace {

using testing::ElementsAre;

template <typename Value>
std::vector<Value> valuesOf(const std::vector<std::uint8_t>& bytes) {
  std::vector<Value> values(bytes.size() / sizeof(Value));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

/// Two rows of three pixels, `padding` behind each.
struct TestFrame {
  explicit TestFrame(int padding) {
    const std::vector<std::uint16_t> values{1000, 0, 2500, 700, 65535, 1};
    for (int row = 0; row < 2; ++row) {
      for (int col = 0; col < 3 + padding; ++col) {
        pixels.push_back(col < 3 ? values[static_cast<std::size_t>(3 * row + col)] : 4242);
      }
    }
    view.data = pixels.data();
    view.width = view.full_width = 3;
    view.height = view.full_height = 2;
    view.stride_px = 3 + padding;
  }
  std::vector<std::uint16_t> pixels;
  DepthFrame view;
};

TEST(DepthFrame, MillimetresAreCopiedWithoutPadding) {
  for (const int padding : {0, 2}) {
    std::vector<std::uint8_t> bytes(100, 0xab);  // of an earlier image
    copyMillimetres(TestFrame(padding).view, bytes);
    EXPECT_THAT(valuesOf<std::uint16_t>(bytes), ElementsAre(1000, 0, 2500, 700, 65535, 1));
  }
}

TEST(DepthFrame, MirroredColumnsAreTurnedBack) {
  TestFrame frame(1);
  frame.view.is_mirrored = true;
  std::vector<std::uint8_t> bytes;
  copyMillimetres(frame.view, bytes);
  EXPECT_THAT(valuesOf<std::uint16_t>(bytes), ElementsAre(2500, 0, 1000, 1, 65535, 700));
}

TEST(DepthFrame, TenthsOfMillimetresAreRounded) {
  TestFrame frame(0);
  frame.view.units_per_mm = 10;
  std::vector<std::uint8_t> bytes;
  copyMillimetres(frame.view, bytes);
  EXPECT_THAT(valuesOf<std::uint16_t>(bytes), ElementsAre(100, 0, 250, 70, 6554, 0));
}

TEST(DepthFrame, MetresHaveNanWhereThereIsNoReading) {
  TestFrame frame(1);
  std::vector<std::uint8_t> bytes;
  copyMetres(frame.view, bytes);
  auto metres = valuesOf<float>(bytes);
  ASSERT_EQ(metres.size(), 6u);
  EXPECT_TRUE(std::isnan(metres[1]));
  EXPECT_FLOAT_EQ(metres[0], 1.0f);
  EXPECT_FLOAT_EQ(metres[5], 0.001f);
  frame.view.units_per_mm = 10;
  copyMetres(frame.view, bytes);
  EXPECT_FLOAT_EQ(valuesOf<float>(bytes)[2], 0.25f);
}

TEST(DepthFrame, FocalLengthFromTheFieldOfView) {
  DepthFrame frame;
  frame.full_width = 640;
  frame.width = 100;  // a part of the image has the same focal length
  frame.horizontal_fov_rad = 2.0 * std::atan(320.0 / 525.0);
  EXPECT_NEAR(factoryFocalLengthPx(frame), 525.0, 1e-9);
  for (const double unknown : {0.0, -1.0, 4.0, std::nan("")}) {
    frame.horizontal_fov_rad = unknown;
    EXPECT_NEAR(factoryFocalLengthPx(frame), 576.0, 0.5);  // PrimeSense's
  }
}

}  // namespace
}  // namespace depth_object_tracker
