// SPDX-License-Identifier: BSD-3-Clause
// Which parameters may change between two images, while the tracker runs.
#pragma once

#include "depth_object_tracker/tracker/tracker_config.h"

#include <string>
#include <vector>

namespace depth_object_tracker {

/// Names as in config/tracker.yaml. The others shape what is built once: sensor model, memory, threads, seed.
const std::vector<std::string>& listLiveParameters();

/// `config` with the live parameters of `changed`.
TrackerConfig withLiveParameters(const TrackerConfig& config, const TrackerConfig& changed);

}  // namespace depth_object_tracker
