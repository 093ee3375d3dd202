// SPDX-License-Identifier: BSD-3-Clause
// A hand holds the object; a board hides it, but not the arm, which is about as round as the object.
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
  int frames;  // until it was hidden once and is seen again
};
std::ostream& operator<<(std::ostream& out, const Case& tested) {
  return out << tested.object << " " << tested.seed;
}

class AnArm : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Objects, AnArm, testing::Values(Case{"mug", 2501, 115}, Case{"bottle", 2505, 120}));

TEST_P(AnArm, IsNotTakenForTheObjectThatItHolds) {
  constexpr double kElsewhereM = 0.05, kSeenShare = 0.5;
  ObjectModel object;
  object.mesh = loadMesh(std::string(PROJECT_SOURCE_FOLDER) + "/meshes/" + GetParam().object + ".obj");
  SimulationConfig config;
  config.occluders = Occluders::kFull;
  config.seed = GetParam().seed;
  SceneSimulator simulator(object.mesh, config);
  ObjectTracker tracker(object, TrackerConfig());
  tracker.initialise(simulator.roughInitialPose());
  int hidden = 0, elsewhere = 0;
  double last_m = 0.0, seen_share = 0.0;
  for (int k = 0; k < GetParam().frames; ++k) {
    const SimulatedFrame& frame = simulator.render(k / 30.0);
    const DepthImageView view = viewOf(frame.depth_mm, config.camera);
    const TrackerResult result = tracker.update(view, config.camera, frame.stamp_s);
    last_m = (result.T_camera_object.translation() - frame.T_camera_object.translation()).norm();
    hidden += frame.visible_pixels == 0 ? 1 : 0;
    elsewhere += result.state == TrackerState::kTracking && last_m > kElsewhereM ? 1 : 0;
    seen_share = frame.visibleFraction();
  }
  EXPECT_GT(seen_share, kSeenShare) << "at the end";
  EXPECT_GT(hidden, 15);
  EXPECT_LE(elsewhere, 2);
  EXPECT_LT(last_m, 0.01);
}

}  // namespace
}  // namespace depth_object_tracker
