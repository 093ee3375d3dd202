// SPDX-License-Identifier: BSD-3-Clause
#include "stereo_scene.h"

#include "depth_object_tracker/tools/input_error.h"
#include "json_file.h"

#include <opencv2/imgcodecs.hpp>

#include <cstdio>
#include <filesystem>

namespace depth_object_tracker {
namespace {

cv::Mat readPicture(const StereoScene& scene, const char* side, int frame) {
  char name[48];
  std::snprintf(name, sizeof(name), "/stereo/%s/%06d.png", side, frame);
  return cv::imread(scene.folder + name, cv::IMREAD_GRAYSCALE);
}

}  // namespace

StereoScene loadStereoScene(const std::string& folder) {
  const std::string path = folder + "/stereo.json";
  if (!std::filesystem::exists(path)) {
    throw InputError(path + " is missing; write the scene with simulate_scene --fiducials FILE");
  }
  const nlohmann::json json = readJsonObject(path);
  const auto matrix = numbersAt(json, "cam_K", 9, path);
  const auto place = numbersAt(json, "left_in_camera_m", 3, path);
  StereoScene scene;
  scene.folder = folder;
  scene.camera.left.fx = matrix[0];
  scene.camera.left.cx = matrix[2];
  scene.camera.left.fy = matrix[4];
  scene.camera.left.cy = matrix[5];
  scene.camera.baseline_m = numberAt(json, "baseline_m", path);
  scene.T_camera_left.translation() = Eigen::Vector3d(place[0], place[1], place[2]);
  if (!(scene.camera.baseline_m > 0.0)) throw InputError(path + ": `baseline_m` must be > 0");
  return scene;
}

StereoPictures readStereoPictures(const StereoScene& scene, int frame) {
  return {readPicture(scene, "left", frame), readPicture(scene, "right", frame)};
}

GrayImageView viewOf(const cv::Mat& picture) {
  return {picture.data, picture.cols, picture.rows, picture.step};
}

}  // namespace depth_object_tracker
