// SPDX-License-Identifier: BSD-3-Clause
// Command line: writes a simulated sequence as a BOP scene folder.
#include "depth_object_tracker/simulator/random_source.h"
#include "depth_object_tracker/simulator/scene_simulator.h"
#include "depth_object_tracker/simulator/scene_writer.h"
#include "depth_object_tracker/tracker/object_model.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>

namespace dot = depth_object_tracker;

namespace {

struct Options {
  std::string output, object, scenario = "human", speed = "medium", occluders = "none";
  int frames = 150;
  double fps = 30.0;
  double stamp_jitter_s = 0.0;
  std::uint64_t seed = 1;
  double init_error_m = 0.005;
  double init_error_deg = 4.0;
  int occlusion_every = 10;
  std::string robot_urdf, fiducials;
  double hand_coverage = -1.0;
};

// The folder above `file` whose package.xml carries the name; "" when there is none. Works without ROS.
std::string findPackageAbove(const std::string& file, const std::string& package) {
  std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  for (; folder != folder.root_path(); folder = folder.parent_path()) {
    std::ifstream manifest(folder / "package.xml");
    const std::string text{std::istreambuf_iterator<char>(manifest), {}};
    if (text.find("<name>" + package + "</name>") != std::string::npos) return folder.string();
  }
  return "";
}

dot::ObjectModel loadObject(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  if (extension == ".yaml" || extension == ".yml") {
    return dot::loadObject(dot::loadObjectDescription(file),
                           [&](const std::string& package) { return findPackageAbove(file, package); });
  }
  dot::ObjectModel object;
  object.name = std::filesystem::path(file).stem().string();
  object.mesh = dot::loadMesh(file);
  return object;
}

void addOptions(CLI::App& app, Options& options) {
  app.add_option("output", options.output, "folder to write; created if needed")->required();
  app.add_option("--object", options.object, "object YAML, or a mesh in metres")->required();
  app.add_option("--scenario", options.scenario, "human, robot, slip or static")->capture_default_str();
  app.add_option("--speed", options.speed, "slow, medium or fast")->capture_default_str();
  app.add_option("--occluders", options.occluders, "none, passing or full")->capture_default_str();
  app.add_option("--frames", options.frames)->check(CLI::Range(1, 100000))->capture_default_str();
  app.add_option("--fps", options.fps)->check(CLI::Range(1.0, 1000.0))->capture_default_str();
  app.add_option("--stamp-jitter", options.stamp_jitter_s, "stamps are off by up to this [s], the motion with them")
      ->check(CLI::Range(0.0, 0.5))
      ->capture_default_str();
  app.add_option("--seed", options.seed)->capture_default_str();
  app.add_option("--robot", options.robot_urdf, "URDF of the arm that holds the object, as config/robots/arm.urdf");
  app.add_option("--fiducials", options.fiducials,
                 "AprilTags on the object (YAML, see config/fiducials): adds grey stereo pictures");
  app.add_option("--hand-coverage", options.hand_coverage,
                 "share of the object that the hand or gripper (not --robot) hides")
      ->check(CLI::Range(0.0, 0.95));
  app.add_option("--init-error-m", options.init_error_m, "error of init.json [m]")->capture_default_str();
  app.add_option("--init-error-deg", options.init_error_deg, "error of init.json [degrees]")->capture_default_str();
  app.add_option("--occlusion-every", options.occlusion_every, "a true mask for every so many frames")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
}

void simulate(const Options& options) {
  const dot::ObjectModel object = loadObject(options.object);
  dot::SimulationConfig config;
  config.scenario = dot::scenarioFromName(options.scenario);
  config.speed = dot::speedFromName(options.speed);
  config.occluders = dot::occludersFromName(options.occluders);
  config.seed = options.seed;
  config.robot_urdf = options.robot_urdf;
  config.fiducials_file = options.fiducials;
  config.hand_coverage = options.hand_coverage;
  config.duration_s = options.frames / options.fps;
  const auto begin = std::chrono::steady_clock::now();
  dot::SceneSimulator simulator(object.mesh, config);
  const dot::Pose init = simulator.roughInitialPose(options.init_error_m, options.init_error_deg * M_PI / 180.0);
  dot::SceneWriter writer(options.output, object, config.camera, init, options.occlusion_every);
  if (!options.fiducials.empty()) writer.addStereo(config.stereo, options.fiducials);
  dot::RandomSource random(options.seed, 1);
  // Two stamps never change places.
  const double jitter_s = std::min(options.stamp_jitter_s, 0.45 / options.fps);
  double visible_sum = 0.0, visible_min = 1.0, render_s = 0.0;
  for (int frame = 0; frame < options.frames; ++frame) {
    const double jitter = frame == 0 ? 0.0 : random.uniform(-jitter_s, jitter_s);
    const auto render_begin = std::chrono::steady_clock::now();
    const dot::SimulatedFrame& image = simulator.render(frame / options.fps + jitter);
    render_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - render_begin).count();
    writer.add(image);
    visible_sum += image.visibleFraction();
    visible_min = std::min(visible_min, image.visibleFraction());
  }
  writer.finish();
  const double total_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::cout << options.output << ": " << options.frames << " frames of '" << object.name << "', visible "
            << 100.0 * visible_sum / options.frames << " % on average, " << 100.0 * visible_min << " % at least; "
            << 1000.0 * render_s / options.frames << " ms a frame, " << total_s << " s in all\n";
}

int run(int argc, char** argv) {
  CLI::App app("Simulates a depth camera before which one object is moved, and writes a BOP scene folder.");
  Options options;
  addOptions(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  simulate(options);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << '\n';
    return 1;
  }
}
