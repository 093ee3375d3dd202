// SPDX-License-Identifier: BSD-3-Clause
// From what the parameters or a service call name to a tracker that is ready for its first image.
#pragma once

#include "depth_object_tracker/geometry/file_access.h"
#include "depth_object_tracker/ros/parameter_loader.h"
#include "depth_object_tracker/tracker/object_tracker.h"

#include <memory>
#include <string>
#include <vector>

namespace depth_object_tracker {

struct BuiltTracker {
  std::shared_ptr<ObjectTracker> tracker;  ///< null when there is a problem
  std::string name;                        ///< of the object; also the tf child frame
  std::string mesh_file;                   ///< absolute path
  double mesh_scale = 1.0;
  TrackerConfig config;  ///< as the tracker was built
  std::string problem;   ///< what was read, what is wrong, what to do
};

/// Loads the mesh, in a process of its own, and builds a tracker; never throws. May take seconds for a large mesh.
/// @param access places that object file and mesh may lie in, besides the packages that `package://` names.
BuiltTracker buildTracker(const ObjectSource& source, const TrackerConfig& config, const FileAccess& access = {});

/// What a service may name: files of packages, of the given folders, and those of the object at start.
FileAccess accessForServices(const std::vector<std::string>& object_folders, const ObjectSource& at_start,
                             const std::string& mesh_file_at_start);

/// Folder of a ROS package, "" when unknown.
std::string findPackage(const std::string& package);

struct InitFilePose {
  Pose T_camera_object = Pose::Identity();
  std::string problem;  ///< empty = usable
};

/// Reads {"cam_R_m2c": [9 numbers, row-major], "cam_t_m2c": [3 numbers, mm]} (the fields of BOP's scene_gt.json).
InitFilePose loadInitFile(const std::string& uri);

}  // namespace depth_object_tracker
