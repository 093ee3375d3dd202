// SPDX-License-Identifier: BSD-3-Clause
// Command line of track_sequence.
#pragma once

#include "depth_object_tracker/tracker/tracker_config.h"

#include <optional>
#include <string>

namespace depth_object_tracker {

struct TrackSequenceOptions {
  std::string scene;
  std::string mesh;         ///< default SCENE/mesh.obj
  double mesh_scale = 1.0;  ///< metres per unit of the mesh file
  std::string models_info;  ///< empty = SCENE/models_info.json if there
  int object_id = 1;
  std::string config;  ///< empty = defaults
  std::string output;
  std::string trace;          ///< empty = none
  std::string occlusion_dir;  ///< empty = none
  std::string init;           ///< empty = first ground truth
  double fps = 30.0;
  int stride = 1;
  bool no_control = false;
  // Given on the command line they win over the configuration file.
  std::optional<int> num_particles;
  std::optional<int> num_threads;
  std::optional<std::uint64_t> seed;
  std::optional<Proposal> proposal;
  std::optional<int> downsampling;  ///< 0 = automatic
};

/// Parses the command line. Prints help or usage errors itself.
/// @return nullopt when the program shall end with `exit_code` (0 after --help, 2 after a usage error).
std::optional<TrackSequenceOptions> parseTrackSequenceOptions(int argc, const char* const* argv, int& exit_code);

/// The configuration file, if any, with the command line's values over it.
/// @throws std::invalid_argument
TrackerConfig makeTrackerConfig(const TrackSequenceOptions& options);

}  // namespace depth_object_tracker
