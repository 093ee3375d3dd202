// SPDX-License-Identifier: BSD-3-Clause
// What is seen where a robot's hand carries an object, and cannot be the object.
#pragma once

#include "depth_object_tracker/geometry/depth_image.h"
#include "depth_object_tracker/geometry/pinhole_camera.h"
#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/geometry/triangle_mesh.h"
#include "depth_object_tracker/render/depth_renderer.h"

#include <vector>

namespace depth_object_tracker {

/// The robot's motion says where the object is, give or take what it may have slipped. What is measured nearer than
/// that is something else: a finger, an arm. Without this, a surface that hides most of the object and lies close
/// before it explains itself better as the object, and draws it along little by little.
class HeldView {
 public:
  explicit HeldView(const TriangleMesh& mesh) : renderer_(mesh) {}

  /// Depth [m] of such readings for each cell of the grid, row-major; 0 = none. Empty when they hide little of the
  /// object, which then speaks for itself, or all of it, when it may be that the robot's motion is wrong. Valid until
  /// the next call.
  /// Once they hid much they count until they hide little.
  /// @param reach_m the object may be nearer than at `T_camera_object` by so much.
  const std::vector<float>& foreignReadings(const DepthImageView& depth, const SamplingGrid& grid,
                                            const Pose& T_camera_object, double reach_m);

  /// The same however much they hide.
  const std::vector<float>& nearerReadings(const DepthImageView& depth, const SamplingGrid& grid,
                                           const Pose& T_camera_object, double reach_m);

  /// Before anything was seen of the object: at the pose that is given something nearer hides most of it, or all, and
  /// goes on beside it. An object that is only nearer than it was said to be does not go on.
  bool isHidden(const DepthImageView& depth, const SamplingGrid& grid, const Pose& T_camera_object, double reach_m);

  /// The object is not held, or not followed.
  void reset() { foreign_.clear(); }

 private:
  bool hidesMuch(const std::vector<CoveredPixel>& covered, const DepthImageView& depth, const SamplingGrid& grid,
                 double reach_m) const;
  void keepNearer(const std::vector<CoveredPixel>& covered, const DepthImageView& depth, const SamplingGrid& grid,
                  double reach_m);
  void expect(const std::vector<CoveredPixel>& covered, const PinholeCamera& camera);

  DepthRenderer renderer_;
  std::vector<float> expected_, foreign_;
};

}  // namespace depth_object_tracker
