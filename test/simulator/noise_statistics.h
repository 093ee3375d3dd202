// SPDX-License-Identifier: BSD-3-Clause
// What a depth camera's pictures look like in numbers: noise on smooth surfaces, holes, outliers at the object's edge.
#pragma once

#include "depth_object_tracker/geometry/depth_image.h"
#include "depth_object_tracker/geometry/pinhole_camera.h"
#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/render/depth_renderer.h"

#include <array>
#include <string>
#include <vector>

namespace depth_object_tracker {

/// Gathers samples over the images of one sequence.
class NoiseStatistics {
 public:
  static constexpr std::array<double, 7> kDepthBins{0.45, 0.6, 0.75, 0.9, 1.2, 1.6, 2.2};  ///< [m], limits
  static constexpr std::size_t kNumBins = kDepthBins.size() - 1;

  explicit NoiseStatistics(const TriangleMesh& object) : renderer_(object) {}

  /// @param camera with the image's size
  void add(const DepthImageView& depth, const PinholeCamera& camera, const Pose& T_camera_object);

  /// Median over smooth 9 x 9 patches of the standard deviation about their own plane [m]; 0 without 50 patches.
  double planeStddev(std::size_t bin) const;
  /// 1.4826 * median absolute deviation of measured minus true depth, inside of the visible object [m].
  double objectStddev() const;
  double interiorHoleShare() const {
    return share(interior_holes_, interior_pixels_);
  }                                                                          ///< > 4 px inside of the outline
  double edgeHoleShare() const { return share(edge_holes_, edge_pixels_); }  ///< up to 2 px inside
  /// Of the readings up to 2 px inside of the outline, those over 2 cm behind the object.
  double edgeOutlierShare() const { return share(edge_behind_, edge_pixels_ - edge_holes_); }

  static std::string header();
  std::string row(const std::string& name) const;

 private:
  void addPatches(const DepthImageView& depth);
  void addObject(const DepthImageView& depth, const PinholeCamera& camera, const Pose& T_camera_object);
  static double share(long part, long whole) {
    return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
  }

  DepthRenderer renderer_;
  std::array<std::vector<double>, kNumBins> plane_stddev_m_;
  std::vector<double> residual_m_;
  long interior_pixels_ = 0, interior_holes_ = 0, edge_pixels_ = 0, edge_holes_ = 0, edge_behind_ = 0;
};

}  // namespace depth_object_tracker
