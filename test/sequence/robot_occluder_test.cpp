// SPDX-License-Identifier: BSD-3-Clause
// The robot's own links as known occluders, placed by joints that are wrong by centimetres: never worse than without.
#include "depth_object_tracker/robot/robot_occluder.h"
#include "depth_object_tracker/simulator/robot_arm.h"
#include "depth_object_tracker/simulator/scene_simulator.h"
#include "depth_object_tracker/simulator/static_world.h"
#include "depth_object_tracker/tracker/object_tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

namespace depth_object_tracker {
namespace {

struct Errors {
  double median_m, worst_m;
};

const std::string kUrdf = std::string(PROJECT_SOURCE_FOLDER) + "/config/robots/arm.urdf";

Errors track(const std::string& object, Scenario scenario, std::uint64_t seed, bool with_occluder) {
  ObjectModel model;
  model.mesh = loadMesh(std::string(PROJECT_SOURCE_FOLDER) + "/meshes/" + object);
  SimulationConfig config;
  config.scenario = scenario;
  config.seed = seed;
  config.robot_urdf = kUrdf;
  SceneSimulator simulator(model.mesh, config);
  const RobotModel robot = RobotModel::fromFile(kUrdf);
  RobotState state(robot, RobotStateConfig());
  RobotOccluder occluder(robot, loadLinkMeshes(robot, LinkShapes::kCollision));
  const Pose T_camera_root = makeCameraMount(config).T_world_camera().inverse() * simulator.robot()->T_world_base();
  ObjectTracker tracker(model, TrackerConfig());
  tracker.initialise(simulator.roughInitialPose());
  std::vector<double> errors;
  for (int k = 0; k < 90; ++k) {
    const double stamp_s = 10.0 + k / 30.0;  // of the joints: 0 would be no stamp
    const SimulatedFrame& frame = simulator.render(k / 30.0);
    const SimulatedJoints joints = simulator.robot()->joints(k / 30.0);
    state.addJointStates({stamp_s, joints.names, joints.positions, joints.velocities});
    EXPECT_GT(occluder.place(state, T_camera_root, stamp_s), 10u);
    DepthImageView view;
    view.data = reinterpret_cast<const std::uint8_t*>(frame.depth_mm.data());
    view.width = config.camera.width;
    view.height = config.camera.height;
    view.step = 2 * static_cast<std::size_t>(view.width);
    const TrackerResult result =
        tracker.update(view, config.camera, frame.stamp_s, frame.control, with_occluder ? &occluder : nullptr);
    if (k > 5) errors.push_back((result.T_camera_object.translation() - frame.T_camera_object.translation()).norm());
  }
  std::sort(errors.begin(), errors.end());
  return {errors[errors.size() / 2], errors.back()};
}

TEST(RobotOccluder, LinksThatAreOffByCentimetresDoNotHarm) {
  for (const auto& [object, scenario, seed] : {std::tuple("mug.obj", Scenario::kSlip, 1),
                                               {"bracket.obj", Scenario::kRobot, 1},
                                               {"drill.obj", Scenario::kRobot, 2},
                                               {"box.obj", Scenario::kRobot, 3}}) {
    const Errors without = track(object, scenario, static_cast<std::uint64_t>(seed), false);
    const Errors with = track(object, scenario, static_cast<std::uint64_t>(seed), true);
    std::cout << object << ": median and worst position error [mm] without " << 1e3 * without.median_m << ' '
              << 1e3 * without.worst_m << ", with the links " << 1e3 * with.median_m << ' ' << 1e3 * with.worst_m
              << '\n';
    EXPECT_LT(with.median_m, 1.15 * without.median_m + 0.00005);
    EXPECT_LT(with.worst_m, 1.5 * without.worst_m + 0.0005);
  }
}

}  // namespace
}  // namespace depth_object_tracker
