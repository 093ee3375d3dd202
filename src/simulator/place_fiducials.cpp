// SPDX-License-Identifier: BSD-3-Clause
// Command line: chooses where to stick AprilTags on an object and writes its fiducial file.
#include "depth_object_tracker/geometry/mesh_loader.h"
#include "depth_object_tracker/simulator/tag_placement.h"

#include <CLI/CLI.hpp>

#include <iostream>

namespace depth_object_tracker {
namespace {

int run(int argc, char** argv) {
  CLI::App app("Chooses flat places for AprilTags (tag36h11) on an object and writes them as a fiducial file.");
  std::string mesh, output;
  TagPlacementConfig config;
  app.add_option("mesh", mesh, "mesh in metres")->required();
  app.add_option("output", output, "YAML file to write")->required();
  app.add_option("--tags", config.num_tags, "at most so many")->check(CLI::Range(1, 500))->capture_default_str();
  app.add_option("--size-m", config.size_m, "edge of the black square")
      ->check(CLI::Range(0.005, 0.5))
      ->capture_default_str();
  app.add_option("--max-unevenness-m", config.max_unevenness_m, "of the surface below a card")
      ->check(CLI::Range(0.0, 0.1))
      ->capture_default_str();
  app.add_option("--seed", config.seed)->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  const FiducialMap map = placeTags(loadMesh(mesh), config);
  saveFiducialMap(map, output);
  std::cout << output << ": " << map.tags.size() << " tags\n";
  return 0;
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  try {
    return depth_object_tracker::run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << '\n';
    return 1;
  }
}
