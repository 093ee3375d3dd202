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

TrialErrors meanOfTrackers(const OccluderTrial& trial, const Row& row, int num_tracker_seeds) {
  TrialErrors mean{0.0, 0.0};
  for (int seed = 1; seed <= num_tracker_seeds; ++seed) {
    const TrialErrors errors = trial.track(row.link_error_camera_m, static_cast<std::uint64_t>(seed));
    mean.median_m += errors.median_m / num_tracker_seeds;
    mean.worst_m += errors.worst_m / num_tracker_seeds;
  }
  return mean;
}

/// One scene a column; the last one is relative to "without", geometric means over all scenes and trackers' seeds.
void printTable(const std::vector<OccluderTrial>& trials, int num_tracker_seeds) {
  std::printf("Position error in mm, median / worst, mean of %d trackers\n\n| |", num_tracker_seeds);
  for (const OccluderTrial& trial : trials) std::printf(" %s |", trial.name().c_str());
  std::printf(" relative to without |\n|---|");
  for (std::size_t k = 0; k <= trials.size(); ++k) std::printf("---|");
  std::printf("\n");
  std::vector<TrialErrors> without;
  for (const Row& row : rows()) {
    std::printf("| %s |", row.title);
    ErrorRatios ratios;
    for (std::size_t k = 0; k < trials.size(); ++k) {
      const TrialErrors errors = meanOfTrackers(trials[k], row, num_tracker_seeds);
      if (!row.link_error_camera_m) without.push_back(errors);
      ratios.add(errors, without[k]);
      std::printf(" %.2f / %.1f |", 1e3 * errors.median_m, 1e3 * errors.worst_m);
      std::fflush(stdout);
    }
    std::printf(" %.3f / %.2f |\n", ratios.median(), ratios.worst());
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Tracks objects in a simulated robot's hand with and without its links as known occluders.");
  int num_frames = 90, num_seeds = 1, num_tracker_seeds = 1;
  app.add_option("--frames", num_frames, "images of each run, 30 a second")
      ->check(CLI::Range(10, 10000))
      ->capture_default_str();
  app.add_option("--seeds", num_seeds, "scenes per object")->check(CLI::Range(1, 100))->capture_default_str();
  app.add_option("--tracker-seeds", num_tracker_seeds, "trackers per scene and row")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    std::vector<OccluderTrial> trials;
    for (int k = 0; k < num_seeds; ++k) {
      const auto more = static_cast<std::uint64_t>(10 * k);
      trials.emplace_back("mug.obj", Scenario::kSlip, 1 + more, num_frames);
      trials.emplace_back("bracket.obj", Scenario::kRobot, 1 + more, num_frames);
      trials.emplace_back("drill.obj", Scenario::kRobot, 2 + more, num_frames);
      trials.emplace_back("box.obj", Scenario::kRobot, 3 + more, num_frames);
    }
    printTable(trials, num_tracker_seeds);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
