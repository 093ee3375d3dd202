// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/simulator_options.h"

#include "depth_object_tracker/geometry/mesh_loader.h"
#include "depth_object_tracker/ros/object_source.h"
#include "depth_object_tracker/ros/option_reader.h"

namespace depth_object_tracker {
namespace {

// The trajectory's peaks and the object's place in the view are checked over so long; it never repeats.
constexpr double kEndlessS = 600.0;
constexpr double kDemoRestS = 0.8;

}  // namespace

SimulatorOptions loadSimulatorOptions(const ros::NodeHandle& private_node) {
  SimulatorOptions options;
  options.simulation.duration_s = kEndlessS;
  options.simulation.first_rest_s = kDemoRestS;
  OptionReader reader(private_node, options.problems);
  reader.read("object_file", "the path of an object's YAML file", options.object_file);
  if (options.object_file.empty()) {
    options.problems.push_back("parameter '" + private_node.resolveName("object_file") +
                               "' is not set; it names the object's YAML file");
  }
  reader.readName("scenario", scenarioFromName, options.simulation.scenario);
  reader.readName("speed", speedFromName, options.simulation.speed);
  reader.readName("occluders", occludersFromName, options.simulation.occluders);
  const auto read_file = [&](const char* key, const char* expected, std::string& path) {
    std::string uri;
    reader.read(key, expected, uri);
    try {
      if (!uri.empty()) path = resolveMeshUri(uri, findPackage);
    } catch (const MeshError& error) {
      options.problems.push_back("parameter '" + private_node.resolveName(key) + "': " + error.what());
    }
  };
  read_file("robot_urdf", "the path of a URDF file", options.simulation.robot_urdf);
  read_file("fiducials_file", "the path of a YAML file", options.simulation.fiducials_file);
  int seed = 1;
  reader.read("seed", "a whole number", seed);
  options.simulation.seed = static_cast<std::uint64_t>(seed);
  reader.readNumber("rate_hz", 1.0, 120.0, options.rate_hz);
  reader.readNumber("wait_for_tracker_s", 0.0, 3600.0, options.wait_for_tracker_s);
  reader.readNumber("init_error_m", 0.0, 1.0, options.init_error_m);
  reader.readNumber("init_error_rad", 0.0, 3.2, options.init_error_rad);
  return options;
}

}  // namespace depth_object_tracker
