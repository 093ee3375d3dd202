// SPDX-License-Identifier: BSD-3-Clause
// Things that may stand before the object and whose place is known, if not exactly: a robot's links, other tracked
// objects.
#pragma once

#include "depth_object_tracker/geometry/pinhole_camera.h"

#include <vector>

namespace depth_object_tracker {

class KnownOccluders {
 public:
  virtual ~KnownOccluders() = default;

  /// Depth [m] of the nearest of them for each pixel of the camera, row-major; 0 = none. Valid until the next call.
  virtual const std::vector<float>& render(const PinholeCamera& camera) = 0;
};

}  // namespace depth_object_tracker
