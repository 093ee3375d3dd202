// SPDX-License-Identifier: BSD-3-Clause
// How a depth image fits an object at a pose, by counting: coarser than the likelihood, but it also looks at what is
// beside the object, and is not misled by how well one patch fits.
#pragma once

#include "depth_object_tracker/model/measured_image.h"
#include "depth_object_tracker/render/depth_tile.h"

namespace depth_object_tracker {

/// Cells with a reading, by what the reading says.
struct TileFit {
  int covered = 0;    ///< covered by the object, with or without a reading
  int matching = 0;   ///< covered, measured at the object's surface, and not on a plane of the background
  int through = 0;    ///< covered, measured behind: the object is not there
  int in_front = 0;   ///< covered, measured in front: occluded
  int beside = 0;     ///< just outside of the outline
  int continued = 0;  ///< ... of which at the depth of the surface beside them
  int behind = 0;     ///< ... of which farther: the object stands out

  int measured() const { return matching + through + in_front; }
};

/// @param tolerance_m, tolerance_per_m a reading matches within tolerance_m + tolerance_per_m * depth^2.
TileFit countTileFit(const DepthTile& tile, const PixelPlanes& planes, float tolerance_m, float tolerance_per_m);

}  // namespace depth_object_tracker
