// SPDX-License-Identifier: BSD-3-Clause
// Simplified versions of a mesh, each with its measured distance from the original.
#pragma once

#include "depth_object_tracker/geometry/triangle_mesh.h"

#include <cstddef>
#include <vector>

namespace depth_object_tracker {

/// One simplified version of a mesh.
struct MeshLevel {
  TriangleMesh mesh;         ///< [m], object frame; no unused vertices; outward winding where the original is closed
  double error_m = 0.0;      ///< rms distance [m] between this surface and the original's, both ways (the larger),
                             ///< measured on random points; 0 for the original
  double max_error_m = 0.0;  ///< largest sampled distance [m]
  double bias_m = 0.0;       ///< mean signed distance [m] along the original's outward normal (a shrunk level has a
                             ///< negative one); 0 when the original is not closed or not oriented
};

/// Versions of a mesh from fine to coarse. The first is the original, welded, without degenerate triangles; every next
/// one has at most about 0.6 times the triangles of the one before, and at most 50,000. Vertices of simplified levels
/// are moved so that the surface lies in the middle of the original's: edge collapse alone shrinks whatever is round. A
/// closed, consistently wound original has closed levels. The same mesh gives the same levels, bit for bit.
/// @param mesh metres; may be open, non-manifold, not welded, or have invalid triangles (they are left out).
/// @param max_error_m no level is further from the original than this (rms) [m]; ends earlier at about 100 triangles,
///   or where no coarser version is found. Not > 0: only the original.
/// @return at least the original; its mesh is empty when no triangle of `mesh` is valid.
std::vector<MeshLevel> makeLevels(const TriangleMesh& mesh, double max_error_m);

/// Index of the coarsest level with error_m <= allowed_error_m [m]; the first when there is none.
std::size_t chooseLevel(const std::vector<MeshLevel>& levels, double allowed_error_m);

}  // namespace depth_object_tracker
