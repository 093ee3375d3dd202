// SPDX-License-Identifier: BSD-3-Clause
// Orientation of closed surfaces, so that a renderer may skip triangles that face away.
#pragma once

#include "depth_object_tracker/geometry/triangle_mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace depth_object_tracker {

/// When triangles run along every edge as often in one direction as in the other, turns each component (triangles
/// connected over edges) counter-clockwise as seen from outside and returns true. Otherwise leaves `triangles` alone
/// and returns false: an open surface, or one with mixed winding, can be seen from either side.
bool orientOutward(const TriangleMesh& mesh, std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace depth_object_tracker
