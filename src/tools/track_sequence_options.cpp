// SPDX-License-Identifier: BSD-3-Clause
// Command line of track_sequence.
#include "depth_object_tracker/tools/track_sequence_options.h"

#include "depth_object_tracker/tracker/tracker_parameters.h"

#include <CLI/CLI.hpp>

#include <filesystem>

namespace depth_object_tracker {
namespace {

/// "auto" or a whole number >= 1, as a sampling factor (0 = auto).
int toDownsampling(const std::string& text) {
  return text == "auto" ? 0 : std::stoi(text);
}

const CLI::Validator kDownsampling(
    [](std::string& text) -> std::string {
      if (text == "auto") return "";
      const bool digits = !text.empty() && text.size() < 5 && text.find_first_not_of("0123456789") == std::string::npos;
      return digits && std::stoi(text) >= 1 ? "" : "must be auto or a whole number >= 1, is \"" + text + "\"";
    },
    "N|auto", "downsampling");

void addInputs(CLI::App& app, TrackSequenceOptions& options) {
  app.add_option("SCENE", options.scene, "BOP scene folder: scene_camera.json, depth/%06d.png, ...")->required();
  app.add_option("--mesh", options.mesh, "mesh of the object (default SCENE/mesh.obj)");
  app.add_option("--mesh-scale", options.mesh_scale, "metres per unit of the mesh file (default 1)")
      ->check(CLI::PositiveNumber);
  app.add_option("--models-info", options.models_info,
                 "BOP models_info.json (default SCENE/models_info.json if there)");
  app.add_option("--object-id", options.object_id, "object in scene_gt.json and models_info.json (default 1)");
  app.add_option("--init", options.init,
                 "initial pose {\"cam_R_m2c\": [9], \"cam_t_m2c\": [3 mm]} (default: first ground truth)");
  app.add_option("--fps", options.fps, "frame rate where scene_camera.json has no timestamp (default 30)")
      ->check(CLI::PositiveNumber);
  app.add_option("--stride", options.stride, "use every N-th frame (default 1)")->check(CLI::PositiveNumber);
  app.add_flag("--no-control", options.no_control, "ignore scene_control.json");
}

void addOutputs(CLI::App& app, TrackSequenceOptions& options) {
  app.add_option("--output", options.output, "estimates, BOP result format (CSV)")->required();
  app.add_option("--trace", options.trace, "one JSON object per frame");
  app.add_option("--occlusion-dir", options.occlusion_dir, "folder for one 8-bit occlusion picture per frame");
}

void addTrackerOptions(CLI::App& app, TrackSequenceOptions& options, std::string& proposal, std::string& downsampling) {
  app.add_option("--config", options.config, "tracker parameters (YAML); the options below win over it");
  app.add_option("--num-particles", options.num_particles, "particles")->check(CLI::PositiveNumber);
  app.add_option("--num-threads", options.num_threads, "threads (default 1)")->check(CLI::PositiveNumber);
  app.add_option("--seed", options.seed, "seed of the random numbers (default 1)")->check(CLI::NonNegativeNumber);
  app.add_option("--proposal", proposal, "informed (default) or process (the paper's)")
      ->check(CLI::IsMember({"informed", "process"}));
  app.add_option("--downsampling", downsampling, "sub-sampling factor or auto (default)")->check(kDownsampling);
}

}  // namespace

std::optional<TrackSequenceOptions> parseTrackSequenceOptions(int argc, const char* const* argv, int& exit_code) {
  TrackSequenceOptions options;
  std::string proposal;
  std::string downsampling;
  CLI::App app("Tracks an object through a sequence of depth images and compares with ground truth where there is one.",
               "track_sequence");
  addInputs(app, options);
  addOutputs(app, options);
  addTrackerOptions(app, options, proposal, downsampling);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    exit_code = app.exit(error) == 0 ? 0 : 2;
    return std::nullopt;
  }
  if (!proposal.empty()) options.proposal = proposal == "process" ? Proposal::kProcess : Proposal::kInformed;
  if (!downsampling.empty()) options.downsampling = toDownsampling(downsampling);
  if (options.mesh.empty()) options.mesh = (std::filesystem::path(options.scene) / "mesh.obj").string();
  return options;
}

TrackerConfig makeTrackerConfig(const TrackSequenceOptions& options) {
  TrackerConfig config = options.config.empty() ? TrackerConfig{} : loadTrackerConfig(options.config);
  if (options.num_particles) config.filter.num_particles = *options.num_particles;
  if (options.num_threads) config.filter.num_threads = *options.num_threads;
  if (options.seed) config.filter.seed = *options.seed;
  if (options.proposal) config.filter.proposal = *options.proposal;
  if (options.downsampling) config.resolution.downsampling = *options.downsampling;
  return config;
}

}  // namespace depth_object_tracker
