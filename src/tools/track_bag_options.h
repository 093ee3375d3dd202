// SPDX-License-Identifier: BSD-3-Clause
// Command line of track_bag.
#pragma once

#include "depth_object_tracker/tracker/tracker_config.h"

#include <cstdint>
#include <optional>
#include <string>

namespace depth_object_tracker {

struct TrackBagOptions {
  std::string bag;
  std::string object;       ///< object YAML, or a mesh in metres
  std::string output;       ///< BOP's result format
  std::string output_bag;   ///< empty = none
  std::string trace;        ///< empty = none
  std::string image_topic;  ///< empty = the only depth image there is
  std::string config;       ///< empty = defaults
  std::string init;         ///< empty = the first ground truth
  std::string urdf;         ///< empty = grasps by links have an unknown motion
  bool find = false;        ///< no initial pose: search the image
  int object_id = 1;        ///< written into the results
  int scene_id = 0;         ///< likewise
  // Given on the command line they win over the configuration file.
  std::optional<int> num_particles;
  std::optional<int> num_threads;
  std::optional<std::uint64_t> seed;
};

/// Parses the command line. Prints help or usage errors itself.
/// @return nullopt when the program shall end with `exit_code` (0 after --help, 2 after a usage error).
std::optional<TrackBagOptions> parseTrackBagOptions(int argc, const char* const* argv, int& exit_code);

/// The configuration file, if any, with the command line's values over it, and without the frame budget: that one looks
/// at the clock.
/// @throws std::invalid_argument
TrackerConfig makeTrackerConfig(const TrackBagOptions& options);

}  // namespace depth_object_tracker
