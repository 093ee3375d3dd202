// SPDX-License-Identifier: BSD-3-Clause
// The depth pictures of a scene, all of one size, whatever single files are like.
#pragma once

#include "depth_object_tracker/tools/bop_scene.h"
#include "depth_object_tracker/tools/depth_picture.h"

#include <functional>
#include <string>
#include <vector>

namespace depth_object_tracker {

class ScenePictures {
 public:
  using Warn = std::function<void(const std::string&)>;

  /// Takes the size from the first picture that can be read. @throws InputError when there is none.
  ScenePictures(const std::vector<SceneFrame>& frames, Warn warn);

  /// The frame's picture. A missing one counts as all missing; so does, with a warning, one that cannot be decoded or
  /// has another size.
  DepthPicture read(const SceneFrame& frame);

  /// Intrinsics of the frame with the pictures' size.
  PinholeCamera camera(const SceneFrame& frame) const;

  int numMissing() const { return num_missing_; }

 private:
  Warn warn_;
  int width_ = 0;
  int height_ = 0;
  int num_missing_ = 0;
};

}  // namespace depth_object_tracker
