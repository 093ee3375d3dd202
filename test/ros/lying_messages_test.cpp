// SPDX-License-Identifier: BSD-3-Clause
// Messages whose sizes lie: whatever is accepted lies inside of what was sent.
#include "depth_object_tracker/robot/joint_state_buffer.h"
#include "depth_object_tracker/ros/camera_conversions.h"
#include "depth_object_tracker/ros/image_conversions.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace depth_object_tracker {
namespace {

constexpr std::array<std::uint32_t, 14> kSizes = {0,     1,     2,          3,          7,          8,          16,
                                                  32767, 32768, 0x7fffffff, 0x80000000, 0xfffffffe, 0xffffffff, 40};

TEST(LyingMessages, NoPixelOfAnAcceptedImageLiesOutsideOfItsData) {
  int num_accepted = 0;
  for (const char* encoding : {"16UC1", "32FC1"}) {
    const std::size_t pixel_bytes = encoding[0] == '1' ? 2 : 4;
    for (const std::uint32_t width : kSizes) {
      for (const std::uint32_t height : kSizes) {
        for (const std::uint32_t step : kSizes) {
          for (const std::size_t num_bytes : {0u, 1u, 15u, 16u, 64u, 128u, 1000u}) {
            sensor_msgs::Image image;
            image.encoding = encoding;
            image.width = width;
            image.height = height;
            image.step = step;
            image.data.resize(num_bytes);
            const ImageViewResult result = viewDepthImage(image);
            if (!result.problem.empty()) continue;
            ++num_accepted;
            const std::size_t last_row = static_cast<std::size_t>(result.view.height - 1) * result.view.step;
            ASSERT_LE(last_row + pixel_bytes * static_cast<std::size_t>(result.view.width), num_bytes)
                << width << "x" << height << ", step " << step;
            result.view.at(result.view.height - 1, result.view.width - 1);
          }
        }
      }
    }
  }
  EXPECT_GT(num_accepted, 100);
}

TEST(LyingMessages, AnAcceptedCameraCanBeUsed) {
  std::mt19937 engine(1);
  const auto anySize = [&] { return kSizes[engine() % kSizes.size()]; };
  const std::array<double, 8> numbers = {0.0,
                                         -1.0,
                                         300.0,
                                         1e308,
                                         -1e308,
                                         1e-308,
                                         std::numeric_limits<double>::quiet_NaN(),
                                         std::numeric_limits<double>::infinity()};
  int num_accepted = 0;
  for (int i = 0; i < 200000; ++i) {
    sensor_msgs::CameraInfo info;
    info.width = 8;
    info.height = 8;
    if (i % 3 == 0) info.width = anySize(), info.height = anySize();
    if (i % 2 == 0) info.binning_x = anySize(), info.binning_y = anySize();
    if (i % 5 == 0) info.roi.x_offset = anySize(), info.roi.y_offset = anySize();
    if (i % 5 == 1) info.roi.width = anySize(), info.roi.height = anySize();
    for (const std::size_t k : {0u, 4u, 2u, 5u}) info.K[k] = i % 7 == 0 ? numbers[engine() % numbers.size()] : 300.0;
    info.D.resize(engine() % 20, numbers[engine() % numbers.size()]);
    const CameraResult result = cameraFromInfo(info, Intrinsics::kRaw, 8, 8);
    hasDistortion(info);
    if (!result.problem.empty()) continue;
    ++num_accepted;
    ASSERT_EQ(result.camera.findProblem(), "");
  }
  EXPECT_GT(num_accepted, 1000);
}

TEST(LyingMessages, JointStatesOfUnequalLengthsAreRefusedWhole) {
  for (std::size_t names = 0; names < 4; ++names) {
    for (std::size_t positions = 0; positions < 5; ++positions) {
      for (std::size_t velocities = 0; velocities < 5; ++velocities) {
        JointStateBuffer buffer;
        JointReport report;
        report.stamp_s = 10.0;
        for (std::size_t i = 0; i < names; ++i) report.names.push_back(std::string(1, static_cast<char>('a' + i)));
        report.positions.assign(positions, 1.0);
        report.velocities.assign(velocities, 1.0);
        const bool fits = (positions == 0 || positions == names) && (velocities == 0 || velocities == names);
        EXPECT_EQ(buffer.add(report).empty(), fits) << names << " " << positions << " " << velocities;
        EXPECT_EQ(buffer.names().size(), fits && (positions > 0 || velocities > 0) ? names : 0u);
      }
    }
  }
}

TEST(LyingMessages, JointStatesCannotFillTheMemory) {
  JointStateBuffer buffer;
  JointReport report;
  report.stamp_s = 10.0;
  for (int i = 0; i < 5000; ++i) report.names.push_back("joint" + std::to_string(i));
  report.positions.assign(report.names.size(), 1.0);
  EXPECT_EQ(buffer.add(report), "there are too many joints");
  EXPECT_LE(buffer.names().size(), JointStateBuffer::kMaxJoints);
}

}  // namespace
}  // namespace depth_object_tracker
