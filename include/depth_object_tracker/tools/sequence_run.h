// SPDX-License-Identifier: BSD-3-Clause
// Runs the tracker over a scene folder and writes what it says.
#pragma once

#include "depth_object_tracker/tools/track_sequence_options.h"

namespace depth_object_tracker {

/// Tracks, writes the files that the options name, prints warnings on standard error and the summary on standard
/// output.
/// @throws std::exception (InputError, MeshError, std::invalid_argument) with one sentence for the user.
void runSequence(const TrackSequenceOptions& options);

}  // namespace depth_object_tracker
