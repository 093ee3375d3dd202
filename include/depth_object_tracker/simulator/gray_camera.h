// SPDX-License-Identifier: BSD-3-Clause
// A simulated grey camera: shaded surfaces, AprilTags, blur and noise.
#pragma once

#include "depth_object_tracker/simulator/tag_texture.h"
#include "depth_object_tracker/simulator/view.h"

#include <cstdint>
#include <vector>

namespace depth_object_tracker {

/// Not thread-safe. Equal seed, picture number and scene give an equal picture.
class GrayCamera {
 public:
  /// @param background the room, in the depth camera's frame. @param noise_stddev grey levels of 255
  GrayCamera(const View& view, const TriangleMesh& background, const FiducialMap& map, double noise_stddev,
             std::uint64_t seed);

  const View& view() const { return view_; }

  /// Starts a picture: the room alone.
  void begin();
  /// Adds a surface seen from view().
  void draw(const std::vector<CoveredPixel>& pixels, float reflectance);
  /// Lights what was drawn, with the tags on the object. @return row-major, width * height; valid until the next call.
  const std::vector<std::uint8_t>& finish(const Pose& T_camera_object, std::uint64_t number);

 private:
  void light();
  void blur();
  void expose(std::uint64_t number);
  Eigen::Vector3d pointAt(int row, int col) const;
  Eigen::Vector3d normalAt(int row, int col) const;

  View view_;
  TagTexture tags_;
  double noise_stddev_;
  std::uint64_t seed_;
  std::vector<float> background_m_, background_gray_, depth_m_, reflectance_, gray_, blurred_;
  std::vector<float> noise_;  // drawn once; every picture begins elsewhere
  std::vector<std::uint8_t> picture_;
};

}  // namespace depth_object_tracker
