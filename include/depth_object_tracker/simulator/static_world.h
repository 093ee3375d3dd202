// SPDX-License-Identifier: BSD-3-Clause
// The room: table, wall, shelf, floor, clutter; and where the camera stands in it.
#pragma once

#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/geometry/triangle_mesh.h"
#include "depth_object_tracker/simulator/simulation_config.h"

namespace depth_object_tracker {

/// Frames: `world` has its origin on the table below the camera, x forward, y left, z up (REP-103); `link` is the
/// camera's body frame (x forward); `camera` is its optical frame (z forward, y down).
struct CameraMount {
  Pose T_world_link = Pose::Identity();
  Pose T_link_camera = Pose::Identity();
  Pose T_world_camera() const { return T_world_link * T_link_camera; }
};
CameraMount makeCameraMount(const SimulationConfig& config);

/// Everything that does not move, in the camera's frame.
TriangleMesh makeStaticWorld(const SimulationConfig& config);

}  // namespace depth_object_tracker
