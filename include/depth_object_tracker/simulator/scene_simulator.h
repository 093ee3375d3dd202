// SPDX-License-Identifier: BSD-3-Clause
// A depth camera before which one object is moved: images and the truth about them.
#pragma once

#include "depth_object_tracker/geometry/triangle_mesh.h"
#include "depth_object_tracker/model/control_input.h"
#include "depth_object_tracker/simulator/simulation_config.h"
#include "depth_object_tracker/simulator/static_world.h"

#include <memory>
#include <optional>
#include <vector>

namespace depth_object_tracker {

struct SimulatedFrame {
  double stamp_s = 0.0;
  Pose T_camera_object = Pose::Identity();  ///< truth: mesh origin in the optical frame
  std::vector<std::uint16_t> depth_mm;      ///< row-major, 0 = no reading
  std::vector<std::uint8_t> occlusion;      ///< row-major: 0 off the object, 128 occluded, 255 visible
  int object_pixels = 0;                    ///< in the image, occluded or not
  int visible_pixels = 0;
  std::optional<ControlInput> control;                 ///< while a robot holds the object
  bool slipping = false;                               ///< it is moving in the robot's hand
  Pose T_camera_object_kinematics = Pose::Identity();  ///< where the robot believes it is; the truth without a robot

  std::vector<std::uint8_t> left, right;  ///< grey pictures, row-major; empty without fiducials

  double visibleFraction() const {
    return object_pixels == 0 ? 0.0 : static_cast<double>(visible_pixels) / object_pixels;
  }
};

class RobotArm;

/// Deterministic for a config and a sequence of stamps. Not thread-safe.
class SceneSimulator {
 public:
  /// @param object metres, at least one triangle.
  /// @throws std::invalid_argument when the mesh is empty or larger than the view can hold.
  SceneSimulator(const TriangleMesh& object, const SimulationConfig& config);
  ~SceneSimulator();

  /// Renders the image of time `stamp_s` [s since the start]; stamps must increase. Valid until the next call.
  const SimulatedFrame& render(double stamp_s);

  /// Whether grey pictures are made; they take most of the time. True at first. Without fiducials there are none
  /// anyway.
  void setStereo(bool enabled);

  /// True pose at any time, nothing rendered.
  Pose truth(double stamp_s);

  /// The pose at the start, wrong by `error_m` and `error_rad` in a random direction: what a person would give.
  Pose roughInitialPose(double error_m = 0.005, double error_rad = 0.07);

  const SimulationConfig& config() const;

  /// The robot of a config with `robot_urdf`; null without. Its functions may be called from another thread.
  RobotArm* robot();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace depth_object_tracker
