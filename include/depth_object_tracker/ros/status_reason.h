// SPDX-License-Identifier: BSD-3-Clause
// The reason in words that goes with a state that is not TRACKING.
#pragma once

#include "depth_object_tracker/tracker/tracker_result.h"

#include <string>
#include <vector>

namespace depth_object_tracker {

/// Why nothing happens when nobody has said where the object is.
extern const char* const kNoInitialPoseReason;

/// Writes the most useful reason: why an initial pose was not granted; what was found wrong with the set-up, from which
/// the state follows; else the tracker's own. A hidden object has its own, whatever else was found.
/// @param initial_pose_problem "" = none. @param findings of the self-check.
void explainState(const std::string& initial_pose_problem, const std::vector<std::string>& findings,
                  TrackerResult& result);

}  // namespace depth_object_tracker
