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

  /// Of those that are seen where they are thought to be, within millimetres: depth as above. What is measured there
  /// is theirs, and nobody else's. Empty = none of them. Valid until the next call.
  virtual const std::vector<float>& renderSeen(const PinholeCamera& /*camera*/) { return nothing_; }

 private:
  std::vector<float> nothing_;
};

}  // namespace depth_object_tracker
