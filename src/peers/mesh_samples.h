// SPDX-License-Identifier: BSD-3-Clause
// Points spread evenly over the surface of a mesh.
#pragma once

#include "depth_object_tracker/geometry/triangle_mesh.h"

#include <cstddef>
#include <vector>

namespace depth_object_tracker {

/// `count` points [m, object frame] with equal area each, the same every time; none when the mesh has no area.
std::vector<Eigen::Vector3f> sampleSurface(const TriangleMesh& mesh, std::size_t count);

}  // namespace depth_object_tracker
