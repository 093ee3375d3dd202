// SPDX-License-Identifier: BSD-3-Clause
// Chooses where AprilTags are stuck on an object.
#pragma once

#include "depth_object_tracker/fiducials/fiducial_map.h"
#include "depth_object_tracker/geometry/triangle_mesh.h"

#include <cstdint>

namespace depth_object_tracker {

struct TagPlacementConfig {
  int num_tags = 12;
  double size_m = 0.025;            ///< edge of the black square; the card is a little larger
  double max_unevenness_m = 0.003;  ///< of the surface below a card
  std::uint64_t seed = 1;
};

/// Spreads cards over flat (or nearly flat) places, looking in all directions. There may be fewer than asked for.
/// @throws std::invalid_argument when the object has no place that is flat enough, with what to do.
FiducialMap placeTags(const TriangleMesh& object, const TagPlacementConfig& config);

}  // namespace depth_object_tracker
