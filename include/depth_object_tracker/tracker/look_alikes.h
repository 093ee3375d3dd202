// SPDX-License-Identifier: BSD-3-Clause
// Turns after which an object looks almost the same: a mug about its axis but for the handle, a box end for end.
#pragma once

#include "depth_object_tracker/geometry/symmetry.h"
#include "depth_object_tracker/geometry/triangle_mesh.h"
#include "depth_object_tracker/tracker/screw_axis.h"

#include <vector>

namespace depth_object_tracker {

/// Turns nearer to one another [rad] are the same look-alike.
constexpr double kLookAlikesApartRad = 0.3;

struct LookAlikes {
  std::vector<Pose> far;        ///< T_centre_centre, the most similar first; none near the identity
  std::vector<ScrewAxis> axes;  ///< that the object can turn about all the way
};

/// @param symmetries about the centre: what looks exactly the same is no look-alike.
LookAlikes findLookAlikes(const TriangleMesh& mesh, const Eigen::Vector3d& centre_object, const Symmetries& symmetries);

}  // namespace depth_object_tracker
