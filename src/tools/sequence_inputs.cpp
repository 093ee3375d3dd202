// SPDX-License-Identifier: BSD-3-Clause
// What a program that tracks through a scene folder reads before its first frame.
#include "depth_object_tracker/tools/sequence_inputs.h"

#include "depth_object_tracker/tools/bop_models_info.h"
#include "depth_object_tracker/tools/input_error.h"

#include <filesystem>
#include <iostream>

namespace depth_object_tracker {
namespace {

namespace fs = std::filesystem;

Symmetries readSymmetries(const TrackSequenceOptions& options) {
  const std::string by_default = (fs::path(options.scene) / "models_info.json").string();
  if (options.models_info.empty() && !fs::exists(by_default)) return {};
  const std::string file = options.models_info.empty() ? by_default : options.models_info;
  const std::optional<Symmetries> symmetries = loadBopSymmetries(file, options.object_id, options.mesh_scale);
  if (!symmetries)
    warnUser(file + " has no entry \"" + std::to_string(options.object_id) + "\": no symmetries (see --object-id)");
  return symmetries.value_or(Symmetries{});
}

}  // namespace

void warnUser(const std::string& message) {
  std::cerr << "warning: " << message << std::endl;
}

ObjectModel loadObjectModel(const TrackSequenceOptions& options) {
  ObjectDescription description;
  description.name = fs::path(options.mesh).stem().string();
  description.mesh = options.mesh;
  description.mesh_scale = options.mesh_scale;
  description.symmetries = readSymmetries(options);
  return loadObject(description);
}

Pose chooseInitialPose(const TrackSequenceOptions& options, const BopScene& scene) {
  if (!options.init.empty()) return loadPoseFile(options.init);
  if (scene.first_truth) return *scene.first_truth;
  throw InputError("no initial pose: give --init FILE.json, or scene_gt.json with object " +
                   std::to_string(options.object_id) + " in " + scene.folder);
}

}  // namespace depth_object_tracker
