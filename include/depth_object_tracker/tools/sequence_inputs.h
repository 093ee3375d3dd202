// SPDX-License-Identifier: BSD-3-Clause
// What a program that tracks through a scene folder reads before its first frame.
#pragma once

#include "depth_object_tracker/tools/bop_scene.h"
#include "depth_object_tracker/tools/track_sequence_options.h"
#include "depth_object_tracker/tracker/object_model.h"

#include <string>

namespace depth_object_tracker {

/// One "warning: ..." line on standard error.
void warnUser(const std::string& message);

/// Mesh and symmetries that the options name. @throws InputError, MeshError
ObjectModel loadObjectModel(const TrackSequenceOptions& options);

/// --init, else the first ground truth. @throws InputError when there is neither.
Pose chooseInitialPose(const TrackSequenceOptions& options, const BopScene& scene);

}  // namespace depth_object_tracker
