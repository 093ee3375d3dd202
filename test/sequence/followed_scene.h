// SPDX-License-Identifier: BSD-3-Clause
// One of our objects in a simulated scene, followed from a rough initial pose.
#pragma once

#include "millimetre_view.h"

#include "depth_object_tracker/geometry/mesh_loader.h"
#include "depth_object_tracker/simulator/scene_simulator.h"
#include "depth_object_tracker/tracker/object_tracker.h"

#include <cstdint>
#include <functional>
#include <ostream>
#include <string>

namespace depth_object_tracker {

struct SceneCase {
  const char* object;
  std::uint64_t seed;
};
inline std::ostream& operator<<(std::ostream& out, const SceneCase& tested) {
  return out << tested.object << " " << tested.seed;
}

/// @param visit called after each image. @param off_m from the object's origin to the estimate's.
/// @return off_m of the last image.
inline double followScene(const std::string& object_name, const SimulationConfig& config, int num_images,
                          const std::function<void(const SimulatedFrame&, const TrackerResult&, double off_m)>& visit,
                          const TrackerConfig& tracker_config = TrackerConfig()) {
  constexpr double kImagesPerS = 30.0;
  ObjectModel object;
  object.mesh = loadMesh(std::string(PROJECT_SOURCE_FOLDER) + "/meshes/" + object_name + ".obj");
  SceneSimulator simulator(object.mesh, config);
  ObjectTracker tracker(object, tracker_config);
  tracker.initialise(simulator.roughInitialPose());
  double off_m = 0.0;
  for (int k = 0; k < num_images; ++k) {
    const SimulatedFrame& frame = simulator.render(k / kImagesPerS);
    const TrackerResult result =
        tracker.update(viewOf(frame.depth_mm, config.camera), config.camera, frame.stamp_s, frame.control);
    off_m = (result.T_camera_object.translation() - frame.T_camera_object.translation()).norm();
    visit(frame, result, off_m);
  }
  return off_m;
}

}  // namespace depth_object_tracker
