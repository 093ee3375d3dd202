// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/tracker_result.h"

namespace depth_object_tracker {

const char* stateName(TrackerState state) {
  switch (state) {
    case TrackerState::kUninitialized:
      return "UNINITIALIZED";
    case TrackerState::kInitializing:
      return "INITIALIZING";
    case TrackerState::kTracking:
      return "TRACKING";
    case TrackerState::kOccluded:
      return "OCCLUDED";
    case TrackerState::kLost:
      return "LOST";
  }
  return "UNKNOWN";
}

}  // namespace depth_object_tracker
