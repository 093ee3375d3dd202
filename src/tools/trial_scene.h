// SPDX-License-Identifier: BSD-3-Clause
// Simulated frames in which an object is to be found: held before a table and a wall, or standing on the table.
#pragma once

#include "depth_object_tracker/simulator/scene_simulator.h"
#include "depth_object_tracker/tracker/object_model.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace depth_object_tracker {

struct TrialFrame {
  std::vector<std::uint16_t> depth_mm;  ///< row-major, 0 = no reading
  double stamp_s = 0.0;
  Pose T_camera_object = Pose::Identity();             ///< truth
  Pose T_camera_object_kinematics = Pose::Identity();  ///< where a robot that holds it believes it is
};

struct TrialScene {
  PinholeCamera camera;
  std::vector<TrialFrame> frames;
  Eigen::Vector3d table_normal = Eigen::Vector3d::UnitZ();  ///< unit length, towards the camera
  double table_offset_m = 0.0;                              ///< table_normal . p of the points on the table
};

/// A hand (kHuman) or a gripper (kRobot) moves the object at medium speed. Frames of one trial follow one another at
/// 30 Hz; trials are some seconds apart, so that each shows another pose.
class HeldScenes {
 public:
  /// @throws std::invalid_argument when the object does not fit into the view.
  HeldScenes(const ObjectModel& object, Scenario scenario, std::uint64_t seed);

  /// The next trial's frames, from one that shows at least half of the object if there is one.
  TrialScene next(int num_frames);

 private:
  SceneSimulator simulator_;
  double stamp_s_ = 0.5;
};

/// The object rests on the table in one of the ways in which it stays, turned and placed anyhow.
TrialScene makeTableScene(const ObjectModel& object, int num_frames, std::uint64_t seed);

}  // namespace depth_object_tracker
