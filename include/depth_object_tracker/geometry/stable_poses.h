// SPDX-License-Identifier: BSD-3-Clause
// How an object rests on a plane: the faces of its convex hull on which it stays.
#pragma once

#include "depth_object_tracker/geometry/triangle_mesh.h"

#include <vector>

namespace depth_object_tracker {

/// One way of resting on a plane, up to a turn about the plane's normal and the place on it.
struct StablePose {
  Eigen::Vector3d up;        ///< normal of the plane, towards the object, object axes; unit length
  double height_m = 0.0;     ///< of the given centre above the plane
  double probability = 0.0;  ///< of coming to rest so when dropped anyhow, without bouncing
};

/// @param centre_object where the mass is thought to be, and what heights are counted from [m].
/// @return the likeliest first, probabilities sum to 1. Round objects have one for every face of their polygonal hull.
/// Empty for a mesh without volume.
std::vector<StablePose> stablePoses(const TriangleMesh& mesh, const Eigen::Vector3d& centre_object);

}  // namespace depth_object_tracker
