// SPDX-License-Identifier: BSD-3-Clause
// Chooses how an object is held so that the camera still sees most of it.
#pragma once

#include "depth_object_tracker/geometry/pinhole_camera.h"
#include "depth_object_tracker/simulator/arm.h"
#include "depth_object_tracker/simulator/hand_shapes.h"

#include <cstdint>
#include <vector>

namespace depth_object_tracker {

enum class HandKind { kHuman, kGripper };

struct GraspRequest {
  HandKind kind = HandKind::kHuman;
  std::vector<Pose> T_camera_object;  ///< poses that the object goes through, at least one
  PinholeCamera camera;
  ArmConfig arm;
  double wanted_coverage = 0.2;  ///< share of the object that hand and arm hide on average, [0, 1)
  std::uint64_t seed = 1;
};

/// Tries random grasps and keeps the one whose coverage is nearest to what is wanted, at no pose far above it. An
/// object that no hand can hold (too thick everywhere) is touched by a flat hand from the arm's side.
Hand chooseGrasp(const TriangleMesh& object, const GraspRequest& request);

}  // namespace depth_object_tracker
