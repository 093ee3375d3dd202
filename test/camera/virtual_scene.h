// SPDX-License-Identifier: BSD-3-Clause
// What the virtual depth camera sees: a bracket that moves before a wall. Shared by the driver and by tests that know
// the truth.
#pragma once

#include "depth_object_tracker/geometry/mesh_loader.h"
#include "depth_object_tracker/render/depth_renderer.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace depth_object_tracker {

constexpr const char* kVirtualDeviceUri = "virtual://depth/1";
constexpr const char* kVirtualDeviceSerial = "V-0815";
constexpr const char* kPlugWithColor = "in, with colour";  // what the plug's file says then
constexpr double kVirtualFovRad = 1.0144686707507438;
constexpr double kVirtualVerticalFovRad = 0.78980943449644714;
constexpr std::uint16_t kVirtualWallMm = 1400;
constexpr int kStampPixels = 4;  // the first pixels of an image tell its time, each twelve bits [us]

inline PinholeCamera virtualCamera(int width, int height) {
  const double focal_length_px = 0.5 * width / std::tan(0.5 * kVirtualFovRad);
  return {width, height, focal_length_px, focal_length_px, 0.5 * (width - 1), 0.5 * (height - 1)};
}

/// Pose of the bracket at a time of the device's clock; up to 0.1 m/s and 0.6 rad/s.
inline Pose virtualPose(std::uint64_t time_us) {
  const double time_s = 1e-6 * static_cast<double>(time_us);
  Pose T_camera_object = Pose::Identity();
  T_camera_object.translation() = Eigen::Vector3d(0.06 * std::sin(1.1 * time_s), 0.04 * std::sin(1.7 * time_s),
                                                  0.7 + 0.05 * std::sin(0.9 * time_s));
  T_camera_object.linear() =
      expSo3(Eigen::Vector3d(0.5 + 0.3 * std::sin(0.8 * time_s), -0.4 + 0.3 * std::sin(1.3 * time_s), 0.3));
  return T_camera_object;
}

/// Renders what the camera sees.
class VirtualScene {
 public:
  VirtualScene() : renderer_(loadMesh(std::string(PROJECT_SOURCE_FOLDER) + "/meshes/bracket.obj")) {}

  /// @param pixels width * height, row-major, millimetres
  void render(std::uint64_t time_us, int width, int height, std::uint16_t* pixels) {
    std::fill(pixels, pixels + static_cast<std::ptrdiff_t>(width) * height, kVirtualWallMm);
    for (const CoveredPixel& pixel : renderer_.render(virtualPose(time_us), virtualCamera(width, height))) {
      pixels[pixel.row * width + pixel.col] = static_cast<std::uint16_t>(std::lround(1000.0f * pixel.depth));
    }
    for (int i = 0; i < kStampPixels; ++i) {
      pixels[i] = static_cast<std::uint16_t>(1 + ((time_us >> (12 * i)) & 0xfff));  // 0 would be "no reading"
    }
  }

 private:
  DepthRenderer renderer_;
};

/// Device time [us] that an image carries.
inline std::uint64_t virtualTime(const std::uint16_t* pixels) {
  std::uint64_t time_us = 0;
  for (int i = 0; i < kStampPixels; ++i) time_us |= static_cast<std::uint64_t>(pixels[i] - 1) << (12 * i);
  return time_us;
}

}  // namespace depth_object_tracker
