// SPDX-License-Identifier: BSD-3-Clause
// The object of the benchmarks: a smooth lumpy body with a handle, cut into any number of triangles.
#pragma once

#include "depth_object_tracker/geometry/triangle_mesh.h"

namespace depth_object_tracker {

/// Closed and not convex: the handle hides parts of the body, and shows them through its hole. About 15 cm across.
/// @param num_triangles wanted, >= 200; the mesh has as many to within 5 %.
TriangleMesh makeBenchmarkObject(int num_triangles);

}  // namespace depth_object_tracker
