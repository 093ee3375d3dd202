// SPDX-License-Identifier: BSD-3-Clause
// One of the simulated cameras, and where it stands.
#pragma once

#include "depth_object_tracker/geometry/pinhole_camera.h"
#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/render/depth_renderer.h"

#include <functional>
#include <vector>

namespace depth_object_tracker {

/// The scene is described in the depth camera's frame: T_view_camera takes it to this camera's.
struct View {
  PinholeCamera camera;
  Pose T_view_camera = Pose::Identity();
};

/// What a surface looks like: the share of light that it throws back, [0, 1].
using DrawSurface = std::function<void(const std::vector<CoveredPixel>& pixels, float reflectance)>;

}  // namespace depth_object_tracker
