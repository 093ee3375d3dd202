// SPDX-License-Identifier: BSD-3-Clause
// Where rays meet a mesh: used to lay fingers onto an object's surface.
#pragma once

#include "depth_object_tracker/geometry/triangle_mesh.h"

#include <optional>

namespace depth_object_tracker {

/// Distance along a ray to the nearest point of the surface, in units of |direction|; nothing when it misses.
/// Brute force over all triangles, both sides count.
std::optional<double> castRay(const TriangleMesh& mesh, const Eigen::Vector3d& origin,
                              const Eigen::Vector3d& direction);

}  // namespace depth_object_tracker
