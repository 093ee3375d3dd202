// SPDX-License-Identifier: BSD-3-Clause
#include "occluder_trial.h"

#include "millimetre_view.h"

#include "depth_object_tracker/robot/robot_occluder.h"
#include "depth_object_tracker/simulator/static_world.h"
#include "depth_object_tracker/tracker/object_tracker.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace depth_object_tracker {
namespace {

constexpr int kSettlingFrames = 5;
constexpr double kFramesPerS = 30.0;
constexpr double kBeginS = 10.0;  // of the joints' stamps: 0 would be no stamp

}  // namespace

OccluderTrial::OccluderTrial(const std::string& object, Scenario scenario, std::uint64_t seed, int num_frames)
    : name_(object.substr(0, object.find('.')) + " " + std::to_string(seed)) {
  if (num_frames <= kSettlingFrames + 1) throw std::invalid_argument("too few images");
  model_.mesh = loadMesh(std::string(PROJECT_SOURCE_FOLDER) + "/meshes/" + object);
  config_.scenario = scenario;
  config_.seed = seed;
  config_.robot_urdf = std::string(PROJECT_SOURCE_FOLDER) + "/config/robots/arm.urdf";
  SceneSimulator simulator(model_.mesh, config_);
  initial_ = simulator.roughInitialPose();
  T_camera_root_ = makeCameraMount(config_).T_world_camera().inverse() * simulator.robot()->T_world_base();
  for (int k = 0; k < num_frames; ++k) {
    frames_.push_back(simulator.render(k / kFramesPerS));
    frames_.back().occlusion.clear();  // large, and not needed
    joints_.push_back(simulator.robot()->joints(k / kFramesPerS));
  }
}

TrialErrors OccluderTrial::track(const std::optional<Eigen::Vector3d>& link_error_camera_m, std::uint64_t seed) const {
  const RobotModel robot = RobotModel::fromFile(config_.robot_urdf);
  RobotState state(robot, RobotStateConfig());
  RobotOccluder occluder(robot, loadLinkMeshes(robot, LinkShapes::kCollision));
  Pose T_camera_root = T_camera_root_;
  if (link_error_camera_m) T_camera_root.translation() += *link_error_camera_m;
  TrackerConfig config;
  config.filter.seed = seed;
  ObjectTracker tracker(model_, config);
  tracker.initialise(initial_);
  std::vector<double> errors;
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    const SimulatedFrame& frame = frames_[k];
    const SimulatedJoints& joints = joints_[k];
    const double stamp_s = kBeginS + static_cast<double>(k) / kFramesPerS;
    state.addJointStates({stamp_s, joints.names, joints.positions, joints.velocities});
    if (occluder.place(state, T_camera_root, stamp_s) == 0) throw std::logic_error("no link was placed");
    const TrackerResult result = tracker.update(viewOf(frame.depth_mm, config_.camera), config_.camera, frame.stamp_s,
                                                frame.control, link_error_camera_m ? &occluder : nullptr);
    const double error_m = (result.T_camera_object.translation() - frame.T_camera_object.translation()).norm();
    if (k > kSettlingFrames) errors.push_back(error_m);
  }
  std::sort(errors.begin(), errors.end());
  return {errors[errors.size() / 2], errors.back()};
}

void ErrorRatios::add(const TrialErrors& with, const TrialErrors& without) {
  log_median += std::log(with.median_m / without.median_m);
  log_worst += std::log(with.worst_m / without.worst_m);
  ++count;
}

double ErrorRatios::median() const {
  return std::exp(log_median / count);
}

double ErrorRatios::worst() const {
  return std::exp(log_worst / count);
}

}  // namespace depth_object_tracker
