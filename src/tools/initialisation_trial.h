// SPDX-License-Identifier: BSD-3-Clause
// One way of starting the tracker, tried once.
#pragma once

#include "depth_object_tracker/tools/pose_error.h"
#include "depth_object_tracker/tracker/object_tracker.h"
#include "tools/image_evidence.h"
#include "tools/trial_scene.h"

#include <cstdint>
#include <string>

namespace depth_object_tracker {

/// As in InitializeTracker.srv.
enum class InitialisationMode { kFromPose, kOnTable, kInHand, kGlobal };

/// "FROM_POSE", "ON_TABLE", "IN_HAND", "GLOBAL".
const char* modeName(InitialisationMode mode);

struct TrialOutcome {
  int frames = 0;          ///< until the estimate was right, and stayed so for three frames; 0: it never was
  double compute_s = 0.0;  ///< processor time of all threads until then, or of all frames
  double add_m = 0.0;  ///< ADD (ADD-S where symmetries are declared) in the last frame that was looked at; -1: no pose
  int wrong_frames = 0;  ///< TRACKING with an error over 2 cm
  /// It was never right, and the last image could not have told: it speaks for the true pose with less than 3 nat.
  bool undecidable = false;
  bool plane_found = true;  ///< ON_TABLE: the table's plane was found (1 cm, 2 degrees)
};

/// Starts the tracker as a user would in that mode, wrong by as much as `mode` allows, and lets it run over the frames.
/// @param evidence of the same object. @param seed of the errors.
TrialOutcome runTrial(ObjectTracker& tracker, const PoseErrorMeter& meter, ImageEvidence& evidence,
                      const TrialScene& scene, InitialisationMode mode, std::uint64_t seed);

}  // namespace depth_object_tracker
