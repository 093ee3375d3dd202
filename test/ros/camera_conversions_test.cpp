// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/camera_conversions.h"

#include "depth_messages.h"

#include <gtest/gtest.h>

#include <limits>

namespace depth_object_tracker {
namespace {

void expectCamera(const CameraResult& result, double fx, double fy, double cx, double cy) {
  EXPECT_EQ(result.problem, "");
  EXPECT_NEAR(result.camera.fx, fx, 1e-9);
  EXPECT_NEAR(result.camera.fy, fy, 1e-9);
  EXPECT_NEAR(result.camera.cx, cx, 1e-9);
  EXPECT_NEAR(result.camera.cy, cy, 1e-9);
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(CameraConversions, TellsRectifiedTopicsByTheirLastName) {
  EXPECT_EQ(intrinsicsForTopic("/camera/depth/image_rect"), Intrinsics::kRectified);
  EXPECT_EQ(intrinsicsForTopic("/camera/depth/image_rect_raw"), Intrinsics::kRectified);
  EXPECT_EQ(intrinsicsForTopic("/camera/depth/image_raw"), Intrinsics::kRaw);
  EXPECT_EQ(intrinsicsForTopic("/rectified_camera/image"), Intrinsics::kRaw);
  EXPECT_EQ(intrinsicsForTopic("image_rect"), Intrinsics::kRectified);
}

TEST(CameraConversions, TakesKForRawAndPForRectifiedImages) {
  const auto info = makeCameraInfo(testCamera());
  info->P = {300.0, 0.0, 150.0, -20.0, 0.0, 310.0, 110.0, 0.0, 0.0, 0.0, 1.0, 0.0};
  expectCamera(cameraFromInfo(*info, Intrinsics::kRaw, 320, 240), 285.0, 285.0, 159.5, 119.5);
  expectCamera(cameraFromInfo(*info, Intrinsics::kRectified, 320, 240), 300.0, 310.0, 150.0, 110.0);
}

TEST(CameraConversions, TakesKWhereARectifiedTopicLeavesPEmpty) {
  const auto info = makeCameraInfo(testCamera());
  info->P.fill(0.0);
  expectCamera(cameraFromInfo(*info, Intrinsics::kRectified, 320, 240), 285.0, 285.0, 159.5, 119.5);
  info->D[0] = 0.1;  // now K does not describe the rectified image
  EXPECT_TRUE(contains(cameraFromInfo(*info, Intrinsics::kRectified, 320, 240).problem, "P is not usable"));
}

TEST(CameraConversions, HonoursBinning) {
  const auto info = makeCameraInfo(testCamera());
  info->binning_x = 2;
  info->binning_y = 4;
  expectCamera(cameraFromInfo(*info, Intrinsics::kRaw, 160, 60), 142.5, 71.25, 79.75, 29.875);
}

TEST(CameraConversions, HonoursRegionOfInterestBeforeBinning) {
  const auto info = makeCameraInfo(testCamera());
  info->roi.x_offset = 40;
  info->roi.y_offset = 20;
  info->roi.width = 200;
  info->roi.height = 101;
  expectCamera(cameraFromInfo(*info, Intrinsics::kRaw, 200, 101), 285.0, 285.0, 119.5, 99.5);
  info->binning_x = info->binning_y = 2;
  expectCamera(cameraFromInfo(*info, Intrinsics::kRaw, 100, 50), 142.5, 142.5, 59.75, 49.75);
  expectCamera(cameraFromInfo(*info, Intrinsics::kRaw, 100, 51), 142.5, 142.5, 59.75, 49.75);  // rounded up: also seen
}

TEST(CameraConversions, SeesTheSamePointInACroppedAndBinnedImage) {
  const auto info = makeCameraInfo(testCamera());
  info->roi.x_offset = 40;
  info->roi.y_offset = 20;
  info->roi.width = info->roi.height = 120;
  info->binning_x = info->binning_y = 3;
  const auto result = cameraFromInfo(*info, Intrinsics::kRaw, 40, 40);
  const Eigen::Vector3d p_camera = testCamera().ray(40.0 + 3.0 * 7.0, 20.0 + 3.0 * 11.0);
  EXPECT_NEAR((result.camera.project(p_camera) - Eigen::Vector2d(7.0, 11.0)).norm(), 0.0, 1e-9);
}

TEST(CameraConversions, AcceptsResizedCamerasWhoseKWasScaled) {
  PinholeCamera half = testCamera();
  half.width = 160;
  half.height = 120;
  half.fx = half.fy = 142.5;
  half.cx = 79.75;
  half.cy = 59.75;
  expectCamera(cameraFromInfo(*makeCameraInfo(half), Intrinsics::kRaw, 160, 120), 142.5, 142.5, 79.75, 59.75);
}

TEST(CameraConversions, RefusesAnotherSizeNamingBoth) {
  const auto problem = cameraFromInfo(*makeCameraInfo(testCamera()), Intrinsics::kRaw, 640, 480).problem;
  EXPECT_TRUE(contains(problem, "640x480")) << problem;
  EXPECT_TRUE(contains(problem, "320x240")) << problem;
}

TEST(CameraConversions, RefusesARegionBeyondTheImage) {
  const auto info = makeCameraInfo(testCamera());
  info->roi.x_offset = 0xFFFFFFF0u;  // plus width overflows 32 bits
  info->roi.width = 320;
  info->roi.height = 240;
  EXPECT_TRUE(contains(cameraFromInfo(*info, Intrinsics::kRaw, 320, 240).problem, "roi"));
}

TEST(CameraConversions, RefusesUncalibratedCameras) {
  const auto info = makeCameraInfo(testCamera());
  info->K[0] = 0.0;
  const auto problem = cameraFromInfo(*info, Intrinsics::kRaw, 320, 240).problem;
  EXPECT_TRUE(contains(problem, "fx=0")) << problem;
  EXPECT_TRUE(contains(problem, "K")) << problem;
  info->K[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(cameraFromInfo(*info, Intrinsics::kRaw, 320, 240).problem, "");
  info->K = makeCameraInfo(testCamera())->K;
  info->K[5] = std::numeric_limits<double>::infinity();
  EXPECT_NE(cameraFromInfo(*info, Intrinsics::kRaw, 320, 240).problem, "");
}

TEST(CameraConversions, FindsDistortion) {
  const auto info = makeCameraInfo(testCamera());
  EXPECT_FALSE(hasDistortion(*info));
  info->D[2] = -0.01;
  EXPECT_TRUE(hasDistortion(*info));
  info->D.clear();
  EXPECT_FALSE(hasDistortion(*info));
}

}  // namespace
}  // namespace depth_object_tracker
