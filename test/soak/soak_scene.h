// SPDX-License-Identifier: BSD-3-Clause
// An endless scene: an object wanders before a wall, is hidden, vanishes, comes back elsewhere.
#pragma once

#include "depth_object_tracker/geometry/pinhole_camera.h"
#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/render/depth_renderer.h"

#include <memory>
#include <random>
#include <string>
#include <vector>

namespace depth_object_tracker {

class SoakScene {
 public:
  static constexpr double kFrameS = 1.0 / 30.0;

  explicit SoakScene(std::uint64_t seed);

  static PinholeCamera camera();
  std::size_t numObjects() const { return renderers_.size(); }
  /// For ~load_object.
  static std::string meshUri(std::size_t object);
  void showObject(std::size_t object) { shown_ = object; }

  void hideFor(int frames, double share);  ///< @param share of the image's columns behind a board, in (0, 1]
  void vanishFor(int frames);              ///< gone; comes back at another place
  bool isHidden() const { return hidden_frames_ > 0 || gone_frames_ > 0; }

  /// Moves on by one frame. @return depth in metres, row-major.
  const std::vector<float>& next();

  const Pose& truth() const { return truth_; }
  const Vector6d& twist() const { return twist_; }  ///< of the mesh origin, camera axes

 private:
  void placeAnywhere();

  std::mt19937_64 random_;
  std::vector<std::unique_ptr<DepthRenderer>> renderers_;
  std::size_t shown_ = 0;
  Pose truth_ = Pose::Identity();
  Vector6d twist_ = Vector6d::Zero();
  int hidden_frames_ = 0, gone_frames_ = 0, steady_frames_ = 0;
  double hidden_share_ = 1.0;
  std::vector<float> depth_m_;
};

}  // namespace depth_object_tracker
