// SPDX-License-Identifier: BSD-3-Clause
// Reads a scene folder in the format of the BOP benchmark, with this package's optional extensions.
#include "depth_object_tracker/tools/bop_scene.h"

#include "depth_object_tracker/tools/input_error.h"
#include "json_file.h"
#include "visibility_file.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>

namespace depth_object_tracker {
namespace {

namespace fs = std::filesystem;

int sceneIdOf(const fs::path& folder) {
  const fs::path absolute = fs::weakly_canonical(folder);
  const std::string name = absolute.filename().string();
  const bool is_number = !name.empty() && name.size() < 9 && name.find_first_not_of("0123456789") == std::string::npos;
  return is_number ? std::stoi(name) : 0;
}

PinholeCamera readIntrinsics(const nlohmann::json& entry, const std::string& where, BopScene& scene) {
  const std::vector<double> k = numbersAt(entry, "cam_K", 9, where);
  PinholeCamera camera;
  camera.fx = k[0];
  camera.fy = k[4];
  camera.cx = k[2];
  camera.cy = k[5];
  PinholeCamera with_size = camera;  // findProblem() wants a size, which only the pictures know
  with_size.width = with_size.height = 1;
  const std::string problem = with_size.findProblem();
  if (!problem.empty()) throw InputError(where + ": \"cam_K\" is not usable: " + problem);
  if (k[1] != 0.0 && scene.warnings.empty()) scene.warnings.push_back(where + ": the skew in \"cam_K\" is ignored");
  return camera;
}

SceneFrame readFrame(const std::string& key, const nlohmann::json& entry, const std::string& file, double fps,
                     BopScene& scene) {
  SceneFrame frame;
  frame.id = frameNumber(key, file);
  const std::string where = file + ", frame " + key;
  frame.camera = readIntrinsics(entry, where, scene);
  frame.depth_unit_m = 1e-3 * numberAt(entry, "depth_scale", where);
  if (frame.depth_unit_m <= 0.0)
    throw InputError(where + ": \"depth_scale\" must be above 0 (count times depth_scale = mm)");
  frame.stamp_s = entry.contains("timestamp") ? numberAt(entry, "timestamp", where) : frame.id / fps;
  char name[32];
  std::snprintf(name, sizeof(name), "%06d.png", frame.id);
  frame.depth_path = (fs::path(scene.folder) / "depth" / name).string();
  return frame;
}

void warnAboutMixedStamps(const nlohmann::json& root, const std::string& file, BopScene& scene) {
  const auto stamped =
      std::count_if(root.begin(), root.end(), [](const auto& entry) { return entry.contains("timestamp"); });
  if (stamped == 0 || static_cast<std::size_t>(stamped) == root.size()) return;
  scene.warnings.push_back(file + " has a \"timestamp\" in " + std::to_string(stamped) + " of " +
                           std::to_string(root.size()) + " frames; the others take frame / fps");
}

void readCameras(BopScene& scene, double fps) {
  const std::string file = (fs::path(scene.folder) / "scene_camera.json").string();
  const nlohmann::json root = readJsonObject(file);
  if (root.empty()) throw InputError(file + " lists no frame");
  for (const auto& [key, entry] : root.items()) scene.frames.push_back(readFrame(key, entry, file, fps, scene));
  std::sort(scene.frames.begin(), scene.frames.end(),
            [](const SceneFrame& a, const SceneFrame& b) { return a.id < b.id; });
  const auto twin = std::adjacent_find(scene.frames.begin(), scene.frames.end(),
                                       [](const SceneFrame& a, const SceneFrame& b) { return a.id == b.id; });
  if (twin != scene.frames.end()) throw InputError(file + " lists frame " + std::to_string(twin->id) + " twice");
  warnAboutMixedStamps(root, file, scene);
}

std::optional<Pose> readTruth(const nlohmann::json& entries, int object_id, const std::string& where) {
  if (!entries.is_array()) throw InputError(where + " is not a list of objects");
  for (const nlohmann::json& entry : entries) {
    if (numberAt(entry, "obj_id", where) == object_id) return bopPoseAt(entry, where);
  }
  return std::nullopt;
}

void readGroundTruth(BopScene& scene, int object_id) {
  const std::string file = (fs::path(scene.folder) / "scene_gt.json").string();
  if (!fs::exists(file)) return;
  const nlohmann::json root = readJsonObject(file);
  std::map<int, Pose> truths;
  for (const auto& [key, entries] : root.items()) {
    const int id = frameNumber(key, file);
    const std::optional<Pose> truth = readTruth(entries, object_id, file + ", frame " + key);
    if (truth) truths[id] = *truth;
  }
  if (truths.empty()) {
    scene.warnings.push_back(file + " has no pose of object " + std::to_string(object_id) +
                             " (see --object-id): no errors are computed");
    return;
  }
  scene.first_truth = truths.begin()->second;
  std::size_t missing = 0;
  for (SceneFrame& frame : scene.frames) {
    const auto found = truths.find(frame.id);
    if (found == truths.end()) {
      ++missing;
    } else {
      frame.T_camera_object_truth = found->second;
    }
  }
  if (missing > 0) {
    scene.warnings.push_back(file + " lacks " + std::to_string(missing) + " of " + std::to_string(scene.frames.size()) +
                             " frames: errors are computed on the others");
  }
}

ControlInput readControlEntry(const nlohmann::json& entry, const std::string& where) {
  const auto grasped = entry.is_object() ? entry.find("grasped") : entry.end();
  if (!entry.is_object() || grasped == entry.end() || !grasped->is_boolean()) {
    throw InputError(where + " needs \"grasped\": true or false");
  }
  ControlInput control;
  control.grasped = grasped->get<bool>();
  control.has_twist = entry.contains("linear") || entry.contains("angular");
  if (!control.has_twist) return control;
  const std::vector<double> linear = numbersAt(entry, "linear", 3, where);
  const std::vector<double> angular = numbersAt(entry, "angular", 3, where);
  control.linear_m_s = Eigen::Map<const Eigen::Vector3d>(linear.data());
  control.angular_rad_s = Eigen::Map<const Eigen::Vector3d>(angular.data());
  return control;
}

void readControl(BopScene& scene) {
  const std::string file = (fs::path(scene.folder) / "scene_control.json").string();
  if (!fs::exists(file)) return;
  const nlohmann::json root = readJsonObject(file);
  std::map<int, ControlInput> controls;
  for (const auto& [key, entry] : root.items()) {
    controls[frameNumber(key, file)] = readControlEntry(entry, file + ", frame " + key);
  }
  for (SceneFrame& frame : scene.frames) {
    const auto found = controls.find(frame.id);
    if (found != controls.end() && found->second.grasped) frame.control = found->second;
  }
}

/// Time-weighted mean over frames (first, last]; frame k's control covers (k-1, k].
std::optional<ControlInput> meanControl(const std::vector<SceneFrame>& frames, std::size_t first, std::size_t last) {
  ControlInput mean;
  mean.grasped = true;
  double total_s = 0.0;
  for (std::size_t k = first + 1; k <= last; ++k) {
    if (!frames[k].control) return std::nullopt;
    const double dt_s = std::max(frames[k].stamp_s - frames[k - 1].stamp_s, 0.0);
    mean.has_twist = mean.has_twist && frames[k].control->has_twist;
    mean.linear_m_s += dt_s * frames[k].control->linear_m_s;
    mean.angular_rad_s += dt_s * frames[k].control->angular_rad_s;
    total_s += dt_s;
  }
  if (total_s <= 0.0) return frames[last].control;
  mean.linear_m_s /= total_s;
  mean.angular_rad_s /= total_s;
  return mean;
}

}  // namespace

BopScene loadBopScene(const std::string& folder, const BopSceneOptions& options) {
  if (!fs::is_directory(folder)) throw InputError("there is no scene folder " + folder);
  BopScene scene;
  scene.folder = folder;
  scene.scene_id = sceneIdOf(folder);
  readCameras(scene, options.fps);
  readGroundTruth(scene, options.object_id);
  if (options.use_control) readControl(scene);
  readVisibility(scene);
  return scene;
}

std::vector<SceneFrame> everyNthFrame(const std::vector<SceneFrame>& frames, int stride) {
  const std::size_t step = static_cast<std::size_t>(std::max(stride, 1));
  std::vector<SceneFrame> chosen;
  for (std::size_t k = 0; k < frames.size(); k += step) {
    chosen.push_back(frames[k]);
    if (k > 0 && step > 1) chosen.back().control = meanControl(frames, k - step, k);
  }
  return chosen;
}

Pose loadPoseFile(const std::string& json_file) {
  return bopPoseAt(readJsonObject(json_file), json_file);
}

}  // namespace depth_object_tracker
