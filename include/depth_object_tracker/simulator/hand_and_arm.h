// SPDX-License-Identifier: BSD-3-Clause
// A hand that holds or pushes the object, and the arm behind it, drawn together.
#pragma once

#include "depth_object_tracker/simulator/arm.h"
#include "depth_object_tracker/simulator/grasp_chooser.h"
#include "depth_object_tracker/simulator/view.h"

#include <array>

namespace depth_object_tracker {

/// Not thread-safe.
class HandAndArm {
 public:
  HandAndArm(const TriangleMesh& object, const GraspRequest& request);

  /// @param T_camera_object of the object that the hand touches.
  void draw(const Pose& T_camera_object, const View& view, const DrawSurface& surface);

 private:
  Hand hand_;
  Arm arm_;
  float reflectance_;
  DepthRenderer hand_renderer_;
  std::array<DepthRenderer, 2> link_renderers_;
};

}  // namespace depth_object_tracker
