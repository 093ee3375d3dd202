// SPDX-License-Identifier: BSD-3-Clause
// The depth pictures of a scene, all of one size, whatever single files are like.
#include "depth_object_tracker/tools/scene_pictures.h"

#include "depth_object_tracker/tools/input_error.h"

#include <filesystem>

namespace depth_object_tracker {
namespace {

std::string sizeText(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

}  // namespace

ScenePictures::ScenePictures(const std::vector<SceneFrame>& frames, Warn warn) : warn_(std::move(warn)) {
  std::string first_problem;
  for (const SceneFrame& frame : frames) {
    try {
      const DepthPicture picture = readDepthPicture(frame.depth_path);
      width_ = picture.width;
      height_ = picture.height;
      return;
    } catch (const InputError& error) {
      if (first_problem.empty()) first_problem = error.what();
    }
  }
  throw InputError("no frame has a depth picture that can be read; the first: " + first_problem);
}

DepthPicture ScenePictures::read(const SceneFrame& frame) {
  if (!std::filesystem::exists(frame.depth_path)) {
    ++num_missing_;
    return emptyDepthPicture(width_, height_);
  }
  try {
    DepthPicture picture = readDepthPicture(frame.depth_path);
    if (picture.width == width_ && picture.height == height_) return picture;
    throw InputError(frame.depth_path + " has " + sizeText(picture.width, picture.height) +
                     " pixels, the scene's first picture " + sizeText(width_, height_));
  } catch (const InputError& error) {
    warn_(std::string(error.what()) + "; taken for a frame without any reading");
    return emptyDepthPicture(width_, height_);
  }
}

PinholeCamera ScenePictures::camera(const SceneFrame& frame) const {
  PinholeCamera camera = frame.camera;
  camera.width = width_;
  camera.height = height_;
  return camera;
}

}  // namespace depth_object_tracker
