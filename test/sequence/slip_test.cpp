// SPDX-License-Identifier: BSD-3-Clause
// Slip, decided from depth and the robot's motion, against the simulator's truth.
#include "followed_scene.h"

#include "depth_object_tracker/simulator/scene_simulator.h"
#include "depth_object_tracker/tracker/object_tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace depth_object_tracker {
namespace {

using Decision = std::pair<double, bool>;  // statistic, truth

void track(const std::string& object, Scenario scenario, std::uint64_t seed, std::vector<Decision>& decisions) {
  ObjectModel model;
  model.mesh = loadMesh(std::string(PROJECT_SOURCE_FOLDER) + "/meshes/" + object);
  SimulationConfig config;
  config.scenario = scenario;
  config.seed = seed;
  SceneSimulator simulator(model.mesh, config);
  ObjectTracker tracker(model, TrackerConfig());
  tracker.initialise(simulator.roughInitialPose());
  for (int k = 0; k < 120; ++k) {
    const SimulatedFrame& frame = simulator.render(k / 30.0);
    const DepthImageView view = viewOf(frame.depth_mm, config.camera);
    const TrackerResult result = tracker.update(view, config.camera, frame.stamp_s, frame.control);
    if (result.slip && k > 5) decisions.emplace_back(result.slip->statistic, frame.slipping);
  }
}

// Share of pairs of a slipping and a still frame in which the slipping one has the larger statistic.
double areaUnderRoc(const std::vector<Decision>& decisions) {
  double larger = 0.0, pairs = 0.0;
  for (const Decision& slip : decisions) {
    for (const Decision& still : decisions) {
      if (!slip.second || still.second) continue;
      pairs += 1.0;
      larger += slip.first > still.first ? 1.0 : 0.0;
    }
  }
  return larger / pairs;
}

TEST(Slip, IsToldFromAFirmGraspOfARobotWithWrongKinematics) {
  std::vector<Decision> decisions;
  track("mug.obj", Scenario::kSlip, 1, decisions);
  track("drill.obj", Scenario::kSlip, 11, decisions);
  track("bracket.obj", Scenario::kRobot, 21, decisions);
  EXPECT_GT(areaUnderRoc(decisions), 0.9);
  const double threshold = SlipConfig().slip_threshold;
  const auto alarms = std::count_if(decisions.begin(), decisions.end(),
                                    [&](const Decision& d) { return !d.second && d.first > threshold; });
  const auto still = std::count_if(decisions.begin(), decisions.end(), [](const Decision& d) { return !d.second; });
  EXPECT_LT(static_cast<double>(alarms), 0.04 * static_cast<double>(still));  // also just after a slip
}

TEST(Slip, BehindTheFingersIsFollowedOnceItShows) {
  constexpr int kImages = 150, kSlipsFrom = 120;
  constexpr double kElsewhereM = 0.01;
  SimulationConfig config;
  config.scenario = Scenario::kSlip;
  config.hand_coverage = 0.6;
  config.seed = 3205;
  int elsewhere = 0, images = 0;
  followScene("bottle", config, kImages, [&](const SimulatedFrame&, const TrackerResult&, double off_m) {
    elsewhere += images++ >= kSlipsFrom && off_m > kElsewhereM ? 1 : 0;
  });
  EXPECT_LE(elsewhere, 6);
}

}  // namespace
}  // namespace depth_object_tracker
