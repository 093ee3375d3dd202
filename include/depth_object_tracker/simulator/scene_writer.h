// SPDX-License-Identifier: BSD-3-Clause
// Writes a simulated sequence as a BOP scene folder, with our extensions.
#pragma once

#include "depth_object_tracker/simulator/scene_simulator.h"
#include "depth_object_tracker/tracker/object_model.h"

#include <memory>
#include <string>

namespace depth_object_tracker {

/// Depth pictures and occlusion masks are written as frames come, tables by finish().
class SceneWriter {
 public:
  /// Creates the folder and its mesh.obj, models_info.json and init.json.
  /// @param occlusion_every a mask in occlusion/ for every so many frames, >= 1
  /// @throws std::runtime_error naming the path that cannot be written.
  SceneWriter(const std::string& folder, const ObjectModel& object, const PinholeCamera& camera,
              const Pose& T_camera_object_init, int occlusion_every = 10);
  ~SceneWriter();

  /// Grey pictures will be written too: stereo/left, stereo/right, stereo.json and a copy of the fiducial file as
  /// fiducials.yaml. Call before the first add(). @throws std::runtime_error
  void addStereo(const StereoPairConfig& config, const std::string& fiducials_file);

  /// @throws std::runtime_error
  void add(const SimulatedFrame& frame);

  /// scene_camera.json, scene_gt.json, visibility.csv and, for robots, scene_control.json and fk.csv.
  void finish();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace depth_object_tracker
