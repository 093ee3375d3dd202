// SPDX-License-Identifier: BSD-3-Clause
// A thin object starts to move at up to 1 m/s, along the arm that holds it.
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

class AFastObject : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Objects, AFastObject, testing::Values(Case{"spatula", 2913}, Case{"spatula", 3513}));

TEST_P(AFastObject, IsNotLostOnTheArm) {
  constexpr int kFrames = 120;
  constexpr double kLostM = 0.05;
  ObjectModel object;
  object.mesh = loadMesh(std::string(PROJECT_SOURCE_FOLDER) + "/meshes/" + GetParam().object + ".obj");
  SimulationConfig config;
  config.speed = Speed::kFast;
  config.seed = GetParam().seed;
  SceneSimulator simulator(object.mesh, config);
  ObjectTracker tracker(object, TrackerConfig());
  tracker.initialise(simulator.roughInitialPose());
  int lost = 0;
  double last_m = 0.0;
  for (int k = 0; k < kFrames; ++k) {
    const SimulatedFrame& frame = simulator.render(k / 30.0);
    const DepthImageView view = viewOf(frame.depth_mm, config.camera);
    const TrackerResult result = tracker.update(view, config.camera, frame.stamp_s);
    last_m = (result.T_camera_object.translation() - frame.T_camera_object.translation()).norm();
    lost += last_m > kLostM ? 1 : 0;
  }
  EXPECT_LE(lost, 4);
  EXPECT_LT(last_m, 0.005);
}

}  // namespace
}  // namespace depth_object_tracker
