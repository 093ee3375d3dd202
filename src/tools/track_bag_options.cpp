// SPDX-License-Identifier: BSD-3-Clause
#include "track_bag_options.h"

#include "depth_object_tracker/tracker/tracker_parameters.h"

#include <CLI/CLI.hpp>

namespace depth_object_tracker {

std::optional<TrackBagOptions> parseTrackBagOptions(int argc, const char* const* argv, int& exit_code) {
  TrackBagOptions options;
  CLI::App app(
      "Tracks an object through the depth images of a rosbag, as fast as it goes and without dropping any: the "
      "tracker\n"
      "nodelet's pipeline, with the same bytes out every time (times apart). The bag's tf, /grasp, /control_twist and\n"
      "joint states are used as the nodelet would; /ground_truth/pose is compared with, where there is one.",
      "track_bag");
  app.add_option("BAG", options.bag, "rosbag with a depth image and its camera_info")->required();
  app.add_option("--object", options.object, "object YAML, or a mesh in metres")->required();
  app.add_option("--output", options.output, "estimates, BOP result format (CSV); im_id counts the images from 0")
      ->required();
  app.add_option("--output-bag", options.output_bag, "bag for /tracker/pose, /tracker/twist, /tracker/status and /tf");
  app.add_option("--trace", options.trace, "one JSON object per frame");
  app.add_option("--image-topic", options.image_topic, "depth image (default: the only one)");
  auto* init = app.add_option("--init", options.init,
                              "initial pose {\"cam_R_m2c\": [9], \"cam_t_m2c\": [3 mm]} (default: first ground truth)");
  app.add_flag("--find", options.find, "no initial pose: find the object in the image")->excludes(init);
  app.add_option("--urdf", options.urdf, "robot, for grasps that name a link (plain .urdf)");
  app.add_option("--config", options.config, "tracker parameters (YAML); the options below win over it");
  app.add_option("--num-particles", options.num_particles, "particles")->check(CLI::PositiveNumber);
  app.add_option("--num-threads", options.num_threads, "threads")->check(CLI::PositiveNumber);
  app.add_option("--seed", options.seed, "seed of the random numbers (default 1)")->check(CLI::NonNegativeNumber);
  app.add_option("--object-id", options.object_id, "obj_id of the results (default 1)");
  app.add_option("--scene-id", options.scene_id, "scene_id of the results (default 0)");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    exit_code = app.exit(error) == 0 ? 0 : 2;
    return std::nullopt;
  }
  return options;
}

TrackerConfig makeTrackerConfig(const TrackBagOptions& options) {
  TrackerConfig config = options.config.empty() ? TrackerConfig{} : loadTrackerConfig(options.config);
  if (options.num_particles) config.filter.num_particles = *options.num_particles;
  if (options.num_threads) config.filter.num_threads = *options.num_threads;
  if (options.seed) config.filter.seed = *options.seed;
  config.budget.frame_budget_s = 0.0;
  return config;
}

}  // namespace depth_object_tracker
