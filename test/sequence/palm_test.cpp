// SPDX-License-Identifier: BSD-3-Clause
// A gripper holds the object and hides most of it from the first image on; its palm explains more of the image than
// what is left of the object.
#include "millimetre_view.h"

#include "depth_object_tracker/geometry/mesh_loader.h"
#include "depth_object_tracker/simulator/scene_simulator.h"
#include "depth_object_tracker/tracker/object_tracker.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <ostream>
#include <string>

namespace depth_object_tracker {
namespace {

struct Case {
  const char* object;
  std::uint64_t seed;
};
std::ostream& operator<<(std::ostream& out, const Case& tested) {
  return out << tested.object << " " << tested.seed;
}

class APalm : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Objects, APalm, testing::Values(Case{"bracket", 3210}, Case{"mug", 103}));

TEST_P(APalm, IsNotTakenForTheObjectBeforeIt) {
  constexpr int kFrames = 120;
  constexpr double kCoverage = 0.8, kElsewhereM = 0.015;
  ObjectModel object;
  object.mesh = loadMesh(std::string(PROJECT_SOURCE_FOLDER) + "/meshes/" + GetParam().object + ".obj");
  SimulationConfig config;
  config.scenario = Scenario::kRobot;
  config.hand_coverage = kCoverage;
  config.seed = GetParam().seed;
  SceneSimulator simulator(object.mesh, config);
  ObjectTracker tracker(object, TrackerConfig());
  tracker.initialise(simulator.roughInitialPose());
  int elsewhere = 0;
  double last_m = 0.0;
  for (int k = 0; k < kFrames; ++k) {
    const SimulatedFrame& frame = simulator.render(k / 30.0);
    const DepthImageView view = viewOf(frame.depth_mm, config.camera);
    const TrackerResult result = tracker.update(view, config.camera, frame.stamp_s, frame.control);
    last_m = (result.T_camera_object.translation() - frame.T_camera_object.translation()).norm();
    elsewhere += result.state == TrackerState::kTracking && last_m > kElsewhereM ? 1 : 0;
  }
  EXPECT_LE(elsewhere, 3);
  EXPECT_LT(last_m, 0.005);
}

}  // namespace
}  // namespace depth_object_tracker
