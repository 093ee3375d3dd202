// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/image_conversions.h"

#include "depth_messages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace depth_object_tracker {
namespace {

constexpr int kWidth = 5, kHeight = 3;

std::vector<float> ramp() {
  std::vector<float> depth_m;
  for (int i = 0; i < kWidth * kHeight; ++i) depth_m.push_back(0.5f + 0.1f * static_cast<float>(i));
  return depth_m;
}

void expectRamp(const DepthImageView& view) {
  ASSERT_EQ(view.width, kWidth);
  ASSERT_EQ(view.height, kHeight);
  for (int i = 0; i < kWidth * kHeight; ++i) EXPECT_NEAR(view.at(i / kWidth, i % kWidth), ramp()[i], 1e-6f) << i;
}

/// Exchanges the bytes of every pixel and says so in the header.
void makeOtherEndian(sensor_msgs::Image& image, std::size_t pixel_bytes) {
  for (auto pixel = image.data.begin(); pixel != image.data.end(); pixel += static_cast<std::ptrdiff_t>(pixel_bytes)) {
    std::reverse(pixel, pixel + static_cast<std::ptrdiff_t>(pixel_bytes));
  }
  image.is_bigendian = !image.is_bigendian;
}

TEST(ImageConversions, ReadsMillimetresInPlace) {
  const auto image = makeUint16Image(ramp(), kWidth, kHeight);
  const auto result = viewDepthImage(*image);
  EXPECT_EQ(result.problem, "");
  EXPECT_EQ(result.view.data, image->data.data());
  expectRamp(result.view);
}

TEST(ImageConversions, ReadsMono16AsMillimetres) {
  const auto image = makeUint16Image(ramp(), kWidth, kHeight);
  image->encoding = "mono16";
  expectRamp(viewDepthImage(*image).view);
}

TEST(ImageConversions, ReadsMetresInPlace) {
  const auto image = makeFloatImage(ramp(), kWidth, kHeight);
  const auto result = viewDepthImage(*image);
  EXPECT_EQ(result.problem, "");
  EXPECT_EQ(result.view.data, image->data.data());
  expectRamp(result.view);
}

TEST(ImageConversions, SkipsRowPadding) {
  expectRamp(viewDepthImage(*makeUint16Image(ramp(), kWidth, kHeight, 6)).view);
}

TEST(ImageConversions, ReadsTheOtherEndianness) {
  const auto uint16_image = makeUint16Image(ramp(), kWidth, kHeight);
  makeOtherEndian(*uint16_image, 2);
  expectRamp(viewDepthImage(*uint16_image).view);
  const auto float_image = makeFloatImage(ramp(), kWidth, kHeight);
  makeOtherEndian(*float_image, 4);
  expectRamp(viewDepthImage(*float_image).view);
}

TEST(ImageConversions, GivesNanWhereThereIsNoReading) {
  auto depth_m = ramp();
  depth_m[1] = 0.0f;
  EXPECT_TRUE(std::isnan(viewDepthImage(*makeUint16Image(depth_m, kWidth, kHeight)).view.at(0, 1)));
  depth_m[2] = std::numeric_limits<float>::quiet_NaN();
  depth_m[3] = std::numeric_limits<float>::infinity();
  depth_m[4] = -1.0f;
  const auto image = makeFloatImage(depth_m, kWidth, kHeight);
  for (int col = 1; col < 5; ++col) EXPECT_TRUE(std::isnan(viewDepthImage(*image).view.at(0, col))) << col;
}

TEST(ImageConversions, RefusesAnotherEncodingByName) {
  for (const char* encoding : {"rgb8", "16SC1", "64FC1", "mono8", ""}) {
    const auto image = makeUint16Image(ramp(), kWidth, kHeight);
    image->encoding = encoding;
    const auto result = viewDepthImage(*image);
    EXPECT_NE(result.problem.find(std::string("'") + encoding + "'"), std::string::npos) << result.problem;
    EXPECT_NE(result.problem.find("16UC1"), std::string::npos);
  }
}

TEST(ImageConversions, RefusesLessDataThanTheHeaderPromises) {
  const auto image = makeUint16Image(ramp(), kWidth, kHeight);
  image->data.pop_back();
  const auto result = viewDepthImage(*image);
  EXPECT_NE(result.problem.find("29 bytes"), std::string::npos) << result.problem;
  EXPECT_NE(result.problem.find("promises 30"), std::string::npos) << result.problem;
  image->data.clear();
  EXPECT_NE(viewDepthImage(*image).problem, "");
}

TEST(ImageConversions, RefusesStepsShorterThanARow) {
  const auto image = makeFloatImage(ramp(), kWidth, kHeight);
  image->step = 4 * kWidth - 1;
  EXPECT_NE(viewDepthImage(*image).problem.find("step=19"), std::string::npos);
  image->step = 0;
  EXPECT_NE(viewDepthImage(*image).problem, "");
}

TEST(ImageConversions, RefusesAbsurdSizes) {
  const auto image = makeUint16Image(ramp(), kWidth, kHeight);
  image->height = 0;
  EXPECT_NE(viewDepthImage(*image).problem.find("5x0"), std::string::npos);
  image->height = 0xFFFFFFFFu;  // times step overflows 32 bits
  EXPECT_NE(viewDepthImage(*image).problem, "");
  image->height = kHeight;
  image->width = 0x80000005u;
  image->step = 10;  // = 2 * width in 32 bits
  EXPECT_NE(viewDepthImage(*image).problem, "");
}

}  // namespace
}  // namespace depth_object_tracker
