// SPDX-License-Identifier: BSD-3-Clause
// A made-up scene as camera messages: a mesh of the package before a flat wall.
#pragma once

#include "depth_object_tracker/geometry/mesh_loader.h"
#include "depth_object_tracker/render/depth_renderer.h"

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/image_encodings.h>
#include <boost/make_shared.hpp>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

namespace depth_object_tracker {

inline std::string testMeshFile() {
  return std::string(PROJECT_SOURCE_FOLDER) + "/meshes/bracket.obj";
}

inline PinholeCamera testCamera() {
  PinholeCamera camera;
  camera.width = 320;
  camera.height = 240;
  camera.fx = camera.fy = 285.0;
  camera.cx = 159.5;
  camera.cy = 119.5;
  return camera;
}

inline Pose testPose() {
  Pose T_camera_object = Pose::Identity();
  T_camera_object.translation() = Eigen::Vector3d(0.03, -0.02, 0.6);
  T_camera_object.linear() = expSo3(Eigen::Vector3d(0.5, -0.4, 0.3));
  return T_camera_object;
}

/// Renders the object before a wall.
class TestScene {
 public:
  static constexpr float kWallM = 1.4f;

  TestScene() : renderer_(loadMesh(testMeshFile())) {}

  /// Depth in metres, row-major.
  std::vector<float> depth(const Pose& T_camera_object) {
    const PinholeCamera camera = testCamera();
    std::vector<float> depth_m(static_cast<std::size_t>(camera.width) * camera.height, kWallM);
    for (const CoveredPixel& pixel : renderer_.render(T_camera_object, camera)) {
      depth_m[static_cast<std::size_t>(pixel.row) * camera.width + pixel.col] = pixel.depth;
    }
    return depth_m;
  }

 private:
  DepthRenderer renderer_;
};

/// 16UC1 (millimetres) with `padding_bytes` behind every row.
inline sensor_msgs::ImagePtr makeUint16Image(const std::vector<float>& depth_m, int width, int height,
                                             std::uint32_t padding_bytes = 0) {
  auto image = boost::make_shared<sensor_msgs::Image>();
  image->encoding = sensor_msgs::image_encodings::TYPE_16UC1;
  image->width = static_cast<std::uint32_t>(width);
  image->height = static_cast<std::uint32_t>(height);
  image->step = 2 * image->width + padding_bytes;
  image->data.assign(std::size_t{image->step} * image->height, 0xAB);
  for (int row = 0; row < height; ++row) {
    for (int col = 0; col < width; ++col) {
      const auto mm =
          static_cast<std::uint16_t>(std::lround(1000.0f * depth_m[static_cast<std::size_t>(row) * width + col]));
      std::memcpy(&image->data[static_cast<std::size_t>(row) * image->step + 2 * static_cast<std::size_t>(col)], &mm,
                  2);
    }
  }
  image->header.frame_id = "camera_depth_optical_frame";
  return image;
}

inline sensor_msgs::ImagePtr makeFloatImage(const std::vector<float>& depth_m, int width, int height) {
  auto image = boost::make_shared<sensor_msgs::Image>();
  image->encoding = sensor_msgs::image_encodings::TYPE_32FC1;
  image->width = static_cast<std::uint32_t>(width);
  image->height = static_cast<std::uint32_t>(height);
  image->step = 4 * image->width;
  image->data.resize(std::size_t{image->step} * image->height);
  std::memcpy(image->data.data(), depth_m.data(), image->data.size());
  image->header.frame_id = "camera_depth_optical_frame";
  return image;
}

inline sensor_msgs::CameraInfoPtr makeCameraInfo(const PinholeCamera& camera) {
  auto info = boost::make_shared<sensor_msgs::CameraInfo>();
  info->header.frame_id = "camera_depth_optical_frame";
  info->width = static_cast<std::uint32_t>(camera.width);
  info->height = static_cast<std::uint32_t>(camera.height);
  info->D.assign(5, 0.0);
  info->K = {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0};
  info->R = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  info->P = {camera.fx, 0.0, camera.cx, 0.0, 0.0, camera.fy, camera.cy, 0.0, 0.0, 0.0, 1.0, 0.0};
  return info;
}

}  // namespace depth_object_tracker
