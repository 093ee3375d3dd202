// SPDX-License-Identifier: BSD-3-Clause
// Where a tag is drawn, there it is found.
#include "depth_object_tracker/fiducials/tag_detector.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace depth_object_tracker {
namespace {

struct Canvas {
  int width = 320, height = 240;
  std::vector<std::uint8_t> pixels = std::vector<std::uint8_t>(320 * 240, 120);
  GrayImageView view() const { return {pixels.data(), width, height, static_cast<std::size_t>(width)}; }

  /// Every module is module_px pixels wide; (row, col) is the first pixel of the margin.
  void draw(const TagPicture& tag, int row, int col, int module_px) {
    for (int y = 0; y < tag.width * module_px; ++y) {
      for (int x = 0; x < tag.width * module_px; ++x) {
        pixels[static_cast<std::size_t>((row + y) * width + col + x)] =
            tag.modules[static_cast<std::size_t>(y / module_px * tag.width + x / module_px)];
      }
    }
  }
};

TEST(TagDetector, FindsCornersWithPixelCentresAtIntegers) {
  const TagPicture tag = drawTag("tag36h11", 17);
  EXPECT_EQ(tag.width, 10);
  EXPECT_EQ(tag.square_width, 8);
  Canvas canvas;
  canvas.draw(tag, 40, 70, 6);
  TagDetector detector("tag36h11");
  const auto found = detector.detect(canvas.view());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].id, 17);
  // The black square begins one module (6 pixels) after the margin; its border lies between two pixel centres.
  const double left = 70 + 6 - 0.5, top = 40 + 6 - 0.5, edge = 8 * 6;
  const Eigen::Vector2d expected[] = {{left, top + edge}, {left + edge, top + edge}, {left + edge, top}, {left, top}};
  // Modules with sharp borders: an edge may be seen a fraction of a pixel off, but not all four to the same side.
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_LT((found[0].corners[k] - expected[k]).norm(), 0.25) << k;
    mean += 0.25 * (found[0].corners[k] - expected[k]);
  }
  EXPECT_LT(mean.norm(), 0.2);
}

TEST(TagDetector, LeavesOutANumberThatIsThereTwice) {
  Canvas canvas;
  canvas.draw(drawTag("tag36h11", 3), 20, 20, 6);
  canvas.draw(drawTag("tag36h11", 3), 20, 120, 6);
  canvas.draw(drawTag("tag36h11", 4), 120, 20, 6);
  TagDetector detector("tag36h11");
  const auto found = detector.detect(canvas.view());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].id, 4);
}

TEST(TagDetector, SeesNothingInNothing) {
  TagDetector detector("tag36h11");
  EXPECT_TRUE(detector.detect(Canvas().view()).empty());
}

TEST(TagDetector, RefusesWhatThereIsNot) {
  EXPECT_THROW(TagDetector("tag99"), std::invalid_argument);
  EXPECT_THROW(drawTag("tag36h11", 100000), std::invalid_argument);
  EXPECT_THROW(drawTag("tag36h11", -1), std::invalid_argument);
}

}  // namespace
}  // namespace depth_object_tracker
