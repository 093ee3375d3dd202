// SPDX-License-Identifier: BSD-3-Clause
// A robot that holds the simulated object and believes its encoders.
#pragma once

#include "depth_object_tracker/geometry/pinhole_camera.h"
#include "depth_object_tracker/render/depth_renderer.h"
#include "depth_object_tracker/simulator/simulation_config.h"
#include "depth_object_tracker/simulator/view.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace depth_object_tracker {

/// What the robot says of its joints.
struct SimulatedJoints {
  std::vector<std::string> names;
  std::vector<double> positions;   ///< [rad], of the motors
  std::vector<double> velocities;  ///< [rad/s], of the motors
  std::vector<double> commands;    ///< [rad/s], what the controller asks of the motors; 0 for the fingers
};

/// The encoders sit at the motors: each true joint is its motor plus a stretch of cables and links, which grows with
/// the torque that gravity asks of it and is 18 mm at the hand in the mean, and, with `pushed`, the yielding to
/// somebody who pushes the arm now and then. Thread-safe: images and joint states are published by different threads.
class RobotArm {
 public:
  static constexpr double kMeanStretchM = 0.018;
  static constexpr const char* kHandLink = "hand_link";

  /// Finds a base, a grasp and joints that take the object along its path.
  /// @param wanted path of the object in the camera's frame. @param pushed scenario b of the paper.
  /// @throws std::runtime_error when the URDF cannot be used (a hand as in config/robots/arm.urdf is expected), or no
  /// grasp
  ///   lets the arm follow the path.
  RobotArm(const TriangleMesh& object, const SimulationConfig& config, std::function<Pose(double)> wanted, bool pushed);
  ~RobotArm();

  /// T_camera_object of an object that has not moved in the hand: as it is, and as the robot believes.
  Pose held(double t_s);
  Pose believed(double t_s);

  SimulatedJoints joints(double t_s);
  Pose T_world_base() const;
  const std::string& rootLink() const;

  /// Draws every link. Not thread-safe against itself.
  void draw(double t_s, const View& view, const DrawSurface& surface);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace depth_object_tracker
