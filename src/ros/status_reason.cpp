// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/status_reason.h"

namespace depth_object_tracker {

const char* const kNoInitialPoseReason =
    "no initial pose; drag the mesh in rviz to the object, call ~initialize, publish on ~initial_pose or set "
    "~init_file (a pose, or the word search)";

void explainState(const std::string& initial_pose_problem, const std::vector<std::string>& findings,
                  TrackerResult& result) {
  if (result.state == TrackerState::kTracking) return;
  if (!initial_pose_problem.empty()) {
    result.reason = initial_pose_problem;
  } else if (result.state == TrackerState::kUninitialized) {
    result.reason = kNoInitialPoseReason + (findings.empty() ? "" : ". Besides: " + findings.front());
  } else if (!findings.empty() && result.state != TrackerState::kOccluded) {
    result.reason = findings.front();
  }
}

}  // namespace depth_object_tracker
