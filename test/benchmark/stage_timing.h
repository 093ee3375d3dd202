// SPDX-License-Identifier: BSD-3-Clause
// Where the time of a pose goes: the engine's stages, one by one.
#pragma once

#include "benchmark_scene.h"

#include <array>
#include <string>
#include <vector>

namespace depth_object_tracker {

struct StageTiming {
  std::string name;
  double ns_per_pose = 0.0;  ///< median over the frames; what is done once a frame, divided by the particles
};

/// On the mesh as it is (no level of detail) with one thread. @param min_seconds in all.
std::vector<StageTiming> timeStages(const BenchmarkScene& scene, const TriangleMesh& mesh, double edge_stddev_px,
                                    int num_particles, double min_seconds);

}  // namespace depth_object_tracker
