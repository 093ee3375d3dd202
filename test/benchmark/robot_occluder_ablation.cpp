// SPDX-License-Identifier: BSD-3-Clause
// Program: what the robot's links as known occluders do to tracking, when they are where the joints have them and when
// they are drawn two more centimetres off. Prints a table.
#include "../sequence/occluder_trial.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <iostream>
#include <vector>

namespace {

using namespace depth_object_tracker;

struct Row {
  const char* title;
  std::optional<Eigen::Vector3d> link_error_camera_m;
};

std::vector<Row> rows() {
  constexpr double kErrorM = 0.02;
  return {{"without the links", std::nullopt},
          {"links where the joints have them", Eigen::Vector3d::Zero()},
          {"2 cm to the side", Eigen::Vector3d(kErrorM, 0.0, 0.0)},
          {"2 cm towards the camera", Eigen::Vector3d(0.0, 0.0, -kErrorM)},
          {"2 cm away from it", Eigen::Vector3d(0.0, 0.0, kErrorM)}};
}

void printTable(const std::vector<OccluderTrial>& trials) {
  std::printf("Position error in mm, median / worst\n\n| |");
  for (const OccluderTrial& trial : trials) {
    std::printf(" %s, seed %d |", trial.object.substr(0, trial.object.find('.')).c_str(), static_cast<int>(trial.seed));
  }
  std::printf("\n|---|");
  for (std::size_t k = 0; k < trials.size(); ++k) std::printf("---|");
  std::printf("\n");
  for (const Row& row : rows()) {
    std::printf("| %s |", row.title);
    for (OccluderTrial trial : trials) {
      trial.link_error_camera_m = row.link_error_camera_m;
      const TrialErrors errors = runTrial(trial);
      std::printf(" %.2f / %.1f |", 1e3 * errors.median_m, 1e3 * errors.worst_m);
      std::fflush(stdout);
    }
    std::printf("\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Tracks objects in a simulated robot's hand with and without its links as known occluders.");
  int num_frames = 90, num_seeds = 1;
  app.add_option("--frames", num_frames, "images of each run, 30 a second")
      ->check(CLI::Range(10, 10000))
      ->capture_default_str();
  app.add_option("--seeds", num_seeds, "scenes per object")->check(CLI::Range(1, 100))->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  std::vector<OccluderTrial> trials;
  for (int k = 0; k < num_seeds; ++k) {
    const auto more = static_cast<std::uint64_t>(10 * k);
    trials.push_back({"mug.obj", Scenario::kSlip, 1 + more, num_frames, {}});
    trials.push_back({"bracket.obj", Scenario::kRobot, 1 + more, num_frames, {}});
    trials.push_back({"drill.obj", Scenario::kRobot, 2 + more, num_frames, {}});
    trials.push_back({"box.obj", Scenario::kRobot, 3 + more, num_frames, {}});
  }
  try {
    printTable(trials);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
