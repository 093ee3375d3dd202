// SPDX-License-Identifier: BSD-3-Clause
#include "occluder_trial.h"

#include "depth_object_tracker/robot/robot_occluder.h"
#include "depth_object_tracker/simulator/robot_arm.h"
#include "depth_object_tracker/simulator/scene_simulator.h"
#include "depth_object_tracker/simulator/static_world.h"
#include "depth_object_tracker/tracker/object_tracker.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace depth_object_tracker {
namespace {

constexpr int kSettlingFrames = 5;
constexpr double kFramesPerS = 30.0;
constexpr double kBeginS = 10.0;  // of the joints' stamps: 0 would be no stamp

DepthImageView viewOf(const SimulatedFrame& frame, const PinholeCamera& camera) {
  DepthImageView view;
  view.data = reinterpret_cast<const std::uint8_t*>(frame.depth_mm.data());
  view.width = camera.width;
  view.height = camera.height;
  view.step = 2 * static_cast<std::size_t>(view.width);
  return view;
}

}  // namespace

TrialErrors runTrial(const OccluderTrial& trial) {
  ObjectModel model;
  model.mesh = loadMesh(std::string(PROJECT_SOURCE_FOLDER) + "/meshes/" + trial.object);
  SimulationConfig config;
  config.scenario = trial.scenario;
  config.seed = trial.seed;
  config.robot_urdf = std::string(PROJECT_SOURCE_FOLDER) + "/config/robots/arm.urdf";
  SceneSimulator simulator(model.mesh, config);
  const RobotModel robot = RobotModel::fromFile(config.robot_urdf);
  RobotState state(robot, RobotStateConfig());
  RobotOccluder occluder(robot, loadLinkMeshes(robot, LinkShapes::kCollision));
  Pose T_camera_root = makeCameraMount(config).T_world_camera().inverse() * simulator.robot()->T_world_base();
  if (trial.link_error_camera_m) T_camera_root.translation() += *trial.link_error_camera_m;
  ObjectTracker tracker(model, TrackerConfig());
  tracker.initialise(simulator.roughInitialPose());
  std::vector<double> errors;
  for (int k = 0; k < trial.num_frames; ++k) {
    const double time_s = k / kFramesPerS;
    const SimulatedFrame& frame = simulator.render(time_s);
    const SimulatedJoints joints = simulator.robot()->joints(time_s);
    state.addJointStates({kBeginS + time_s, joints.names, joints.positions, joints.velocities});
    if (occluder.place(state, T_camera_root, kBeginS + time_s) == 0) throw std::logic_error("no link was placed");
    const TrackerResult result = tracker.update(viewOf(frame, config.camera), config.camera, frame.stamp_s,
                                                frame.control, trial.link_error_camera_m ? &occluder : nullptr);
    const double error_m = (result.T_camera_object.translation() - frame.T_camera_object.translation()).norm();
    if (k > kSettlingFrames) errors.push_back(error_m);
  }
  if (errors.empty()) throw std::invalid_argument("too few images");
  std::sort(errors.begin(), errors.end());
  return {errors[errors.size() / 2], errors.back()};
}

}  // namespace depth_object_tracker
