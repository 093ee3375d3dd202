// SPDX-License-Identifier: BSD-3-Clause
// Points with normals from depth images, of surfaces and of readings that no camera should give.
#include "depth_object_tracker/tracker/oriented_points.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace depth_object_tracker {
namespace {

constexpr int kWidth = 64, kHeight = 48;
constexpr double kReachM = 0.01, kMaxDepthM = 6.0;
constexpr int kStepPx = 4;

PinholeCamera camera() {
  PinholeCamera camera;
  camera.width = kWidth;
  camera.height = kHeight;
  camera.fx = camera.fy = 60.0;
  camera.cx = 0.5 * (kWidth - 1);
  camera.cy = 0.5 * (kHeight - 1);
  return camera;
}

DepthImageView viewOf(const std::vector<float>& depth) {
  DepthImageView view;
  view.data = reinterpret_cast<const std::uint8_t*>(depth.data());
  view.width = kWidth;
  view.height = kHeight;
  view.step = sizeof(float) * kWidth;
  view.pixel_type = DepthImageView::PixelType::kFloat32;
  view.unit_m = 1.0f;
  return view;
}

TEST(OrientedPoints, APlanesNormalIsFoundAndLooksAtTheCamera) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.3, -0.2, -1.0).normalized();
  std::vector<float> depth;
  for (int row = 0; row < kHeight; ++row) {
    for (int col = 0; col < kWidth; ++col) {
      depth.push_back(static_cast<float>(-0.8 / normal.dot(camera().ray(col, row))));
    }
  }
  const auto point = orientedPointAt(viewOf(depth), camera(), 24, 32, 0.05);
  ASSERT_TRUE(point.has_value());
  EXPECT_GT(point->normal.dot(normal), 0.9999);
  EXPECT_NEAR(point->point.dot(normal), -0.8, 1e-4);
}

/// A patch or a plane is then as large as billions of pixels.
class OrientedPointsRightBeforeTheLens : public testing::TestWithParam<float> {};

TEST_P(OrientedPointsRightBeforeTheLens, AreHarmless) {
  const std::vector<float> depth(std::size_t{kWidth} * kHeight, GetParam());
  EXPECT_TRUE(allImagePoints(viewOf(depth), camera(), kReachM, kMaxDepthM, kStepPx).empty());
  EXPECT_TRUE(imagePoints(viewOf(depth), camera(), 0.2, kReachM, kMaxDepthM, kStepPx).empty());
}

INSTANTIATE_TEST_SUITE_P(DepthM, OrientedPointsRightBeforeTheLens,
                         testing::Values(1e-38f, 1e-20f, 1e-10f, 3e-10f, 1e-9f, 3e-9f, 1e-8f, 3e-8f, 1e-6f));

}  // namespace
}  // namespace depth_object_tracker
