// SPDX-License-Identifier: BSD-3-Clause
// Poses per second of DepthLikelihood::update.
#pragma once

#include "depth_object_tracker/geometry/triangle_mesh.h"

#include <cstdint>
#include <string>

namespace depth_object_tracker {

/// One measurement. Defaults: the row that all others differ from in one respect.
struct UpdateCase {
  std::string series;  ///< what it is compared with
  int triangles = 5000;
  int particles = 200;
  int factor = 5;
  int covered_pixels = 430;  ///< at factor 5; more on finer grids
  int threads = 1;
  std::string simd = "auto";
  double edge_stddev_px = 0.8;
};

struct UpdateTiming {
  UpdateCase given;
  int triangles = 0, width = 0, height = 0, covered_pixels = 0;  ///< what there really was
  std::string simd;
  int repetitions = 0;
  double poses_per_s = 0.0;            ///< median over the repetitions
  double fastest_poses_per_s = 0.0;    ///< of the fastest one
  double processor_us_per_pose = 0.0;  ///< median; of all threads together. Says more on a machine that others use too
  std::int64_t heap_allocations = 0;   ///< of all repetitions
};

/// Every repetition is a frame: new image and resampling, which are not timed, then update(), which is.
/// @param mesh the object; given.triangles is not looked at. @param min_seconds of update() in all.
UpdateTiming timeUpdate(const UpdateCase& given, const TriangleMesh& mesh, double min_seconds);

}  // namespace depth_object_tracker
