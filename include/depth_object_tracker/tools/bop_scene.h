// SPDX-License-Identifier: BSD-3-Clause
// Reads a scene folder in the format of the BOP benchmark, with this package's optional extensions.
#pragma once

#include "depth_object_tracker/geometry/pinhole_camera.h"
#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/model/control_input.h"

#include <optional>
#include <string>
#include <vector>

namespace depth_object_tracker {

struct SceneFrame {
  int id = 0;                  ///< key in scene_camera.json
  double stamp_s = 0.0;        ///< "timestamp" of scene_camera.json, else id / fps
  std::string depth_path;      ///< depth/%06d.png, which need not exist
  double depth_unit_m = 1e-3;  ///< metres per count of the picture
  PinholeCamera camera;        ///< width and height are 0: only the pictures know them
  std::optional<Pose> T_camera_object_truth;
  std::optional<ControlInput> control;     ///< mean motion over (previous frame, this frame]; nullopt = not held
  std::optional<double> visible_fraction;  ///< of the object, from visibility.csv
};

struct BopScene {
  std::string folder;
  int scene_id = 0;                   ///< the folder's number, else 0
  std::vector<SceneFrame> frames;     ///< in the order of their ids, at least one
  std::optional<Pose> first_truth;    ///< first pose of the object in scene_gt.json
  bool has_visibility = false;        ///< visibility.csv is there
  std::vector<std::string> warnings;  ///< what is odd but usable
};

struct BopSceneOptions {
  int object_id = 1;        ///< whose ground truth
  double fps = 30.0;        ///< > 0, for frames without timestamp
  bool use_control = true;  ///< read scene_control.json when there
};

/// Reads scene_camera.json and, where present, scene_gt.json, scene_control.json and visibility.csv. Opens no picture.
/// @throws InputError naming file, key and what is wrong.
BopScene loadBopScene(const std::string& folder, const BopSceneOptions& options);

/// Every `stride`-th frame, from the first. Control is the time-weighted mean over the skipped frames; an interval in
/// which the object was held only part of the time counts as not held.
/// @param stride >= 1
std::vector<SceneFrame> everyNthFrame(const std::vector<SceneFrame>& frames, int stride);

/// Reads a pose {"cam_R_m2c": [9], "cam_t_m2c": [3, mm]}. Rotations are re-orthonormalised when off by rounding only.
/// @throws InputError naming file, key and what is wrong.
Pose loadPoseFile(const std::string& json_file);

}  // namespace depth_object_tracker
