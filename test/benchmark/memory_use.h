// SPDX-License-Identifier: BSD-3-Clause
// Resident memory of a DepthLikelihood.
#pragma once

#include "depth_object_tracker/geometry/triangle_mesh.h"

namespace depth_object_tracker {

struct MemoryUse {
  int particles = 0;
  double peak_mib = 0.0;     ///< most resident memory of the whole process
  double without_mib = 0.0;  ///< ... of one that only made the scene
  double beliefs_mib = 0.0;  ///< of that: held for beliefs about occlusion
  int tiles_in_use = 0;
};

/// Runs frames in a process of its own, so that what was measured before does not count. Call before any thread starts.
/// @throws std::runtime_error when that process fails.
MemoryUse measureMemory(const TriangleMesh& mesh, int num_particles);

}  // namespace depth_object_tracker
