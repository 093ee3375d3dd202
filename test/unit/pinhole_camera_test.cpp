// SPDX-License-Identifier: BSD-3-Clause
// Projection, sub-sampling that sees the same beams, and complaints about unusable intrinsics.
#include "depth_object_tracker/geometry/pinhole_camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace depth_object_tracker {
namespace {

const PinholeCamera kCamera{640, 480, 571.3, 569.8, 318.7, 242.1};

TEST(PinholeCamera, ProjectInvertsRay) {
  for (const double u : {-12.5, 0.0, 318.7, 639.0}) {
    for (const double v : {-3.0, 0.25, 242.1, 479.0}) {
      const Eigen::Vector2d back = kCamera.project(1.7 * kCamera.ray(u, v));
      EXPECT_NEAR(back.x(), u, 1e-12);
      EXPECT_NEAR(back.y(), v, 1e-12);
    }
  }
  EXPECT_EQ(kCamera.ray(kCamera.cx, kCamera.cy), Eigen::Vector3d::UnitZ());
}

class SamplingGridFactor : public testing::TestWithParam<int> {};

TEST_P(SamplingGridFactor, EveryCellSeesTheBeamOfItsFullPixel) {
  const int factor = GetParam();
  // Sizes that the factor divides and sizes that it does not.
  for (const auto& [width, height] : {std::pair{640, 480}, std::pair{641, 479}, std::pair{37, 23}}) {
    PinholeCamera full = kCamera;
    full.width = width;
    full.height = height;
    const SamplingGrid grid = makeSamplingGrid(full, factor);
    EXPECT_EQ(grid.factor, factor);
    EXPECT_EQ(grid.full, full);
    ASSERT_GT(grid.camera.width, 0);
    ASSERT_GT(grid.camera.height, 0);
    EXPECT_EQ(grid.fullRow(0), factor / 2);
    EXPECT_EQ(grid.fullCol(1) - grid.fullCol(0), factor);
    // The last cell is inside of the image, one more would not be.
    EXPECT_LT(grid.fullCol(grid.camera.width - 1), width);
    EXPECT_GE(grid.fullCol(grid.camera.width), width);
    EXPECT_LT(grid.fullRow(grid.camera.height - 1), height);
    EXPECT_GE(grid.fullRow(grid.camera.height), height);
    for (int row = 0; row < grid.camera.height; ++row) {
      for (int col = 0; col < grid.camera.width; ++col) {
        const Eigen::Vector3d beam = grid.camera.ray(col, row);
        const Eigen::Vector3d full_beam = full.ray(grid.fullCol(col), grid.fullRow(row));
        ASSERT_LT((beam - full_beam).norm(), 1e-13) << "factor " << factor << " cell " << row << "," << col;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Factors, SamplingGridFactor, testing::Range(1, 10));

TEST(SamplingGrid, FactorOneIsTheImageItself) {
  EXPECT_EQ(makeSamplingGrid(kCamera, 1).camera, kCamera);
}

TEST(PinholeCamera, GoodIntrinsicsHaveNoProblem) {
  EXPECT_EQ(kCamera.findProblem(), "");
}

TEST(PinholeCamera, ProblemsNameTheField) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const std::vector<std::pair<std::string, std::function<void(PinholeCamera&)>>> cases = {
      {"size", [](PinholeCamera& c) { c.width = 0; }},
      {"size", [](PinholeCamera& c) { c.width = -640; }},
      {"size", [](PinholeCamera& c) { c.height = 0; }},
      {"fx", [](PinholeCamera& c) { c.fx = 0.0; }},
      {"fx", [=](PinholeCamera& c) { c.fx = nan; }},
      {"fy", [](PinholeCamera& c) { c.fy = -1.0; }},
      {"fy", [=](PinholeCamera& c) { c.fy = infinity; }},
      {"principal point", [=](PinholeCamera& c) { c.cx = nan; }},
      {"principal point", [=](PinholeCamera& c) { c.cy = -infinity; }},
  };
  for (const auto& [field, spoil] : cases) {
    PinholeCamera camera = kCamera;
    spoil(camera);
    EXPECT_NE(camera.findProblem().find(field), std::string::npos) << field << ": '" << camera.findProblem() << "'";
  }
}

}  // namespace
}  // namespace depth_object_tracker
