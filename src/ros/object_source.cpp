// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/object_source.h"

#include "depth_object_tracker/geometry/isolated_mesh_loader.h"

#include <ros/package.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <utility>
#include <vector>

namespace depth_object_tracker {
namespace {

constexpr std::uintmax_t kMaxInitFileBytes = 1 << 20;
constexpr double kMaxRotationError = 1e-2;  // files round to a few digits
constexpr const char* kAccessAdvice =
    "; name it as package://NAME/PATH, or list its folder in ~object_folders and start again";
constexpr const char* kInitFormat = R"({"cam_R_m2c": [9 numbers], "cam_t_m2c": [3 numbers, mm]})";

ObjectDescription describe(const ObjectSource& source, const FileAccess& access) {
  if (!source.object_file.empty()) {
    return loadObjectDescription(resolveMeshUri(source.object_file, findPackage), access);
  }
  if (source.mesh.empty()) {
    throw std::invalid_argument(
        "no object: set ~object_file (an object's YAML) or ~mesh (a mesh file), or call ~load_object");
  }
  if (!std::isfinite(source.mesh_scale) || source.mesh_scale <= 0.0) {
    throw std::invalid_argument("mesh_scale is " + std::to_string(source.mesh_scale) +
                                "; it must be positive (metres per unit of the mesh)");
  }
  ObjectDescription description;
  description.name = source.name;
  description.mesh = source.mesh;
  description.mesh_scale = source.mesh_scale;
  return description;
}

/// The object's name is its tf frame, and tf frames are words.
std::string frameName(const std::string& name, const std::string& mesh_file) {
  std::string frame = name.empty() ? std::filesystem::path(mesh_file).stem().string() : name;
  const auto is_odd = [](unsigned char letter) {
    return std::isalnum(letter) == 0 && letter != '_' && letter != '-' && letter != '.';
  };
  std::replace_if(frame.begin(), frame.end(), is_odd, '_');
  return frame.empty() ? "object" : frame;
}

Pose poseFromNumbers(const std::vector<double>& rotation, const std::vector<double>& translation_mm) {
  if (rotation.size() != 9 || translation_mm.size() != 3) {
    throw std::invalid_argument("cam_R_m2c must have 9 numbers and cam_t_m2c 3, but they have " +
                                std::to_string(rotation.size()) + " and " + std::to_string(translation_mm.size()));
  }
  const Eigen::Matrix3d matrix = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rotation.data());
  const double error = (matrix * matrix.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(error < kMaxRotationError) || matrix.determinant() < 0.0) {
    throw std::invalid_argument("cam_R_m2c is not a rotation matrix");
  }
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond(matrix).normalized().toRotationMatrix();
  pose.translation() = Eigen::Map<const Eigen::Vector3d>(translation_mm.data()) * 0.001;
  if (!pose.translation().allFinite()) throw std::invalid_argument("cam_t_m2c is not finite");
  return pose;
}

}  // namespace

std::string findPackage(const std::string& package) {
  return ros::package::getPath(package);
}

FileAccess accessForServices(const std::vector<std::string>& object_folders, const ObjectSource& at_start,
                             const std::string& mesh_file_at_start) {
  FileAccess access = FileAccess::only(object_folders, kAccessAdvice).with(findPackage("depth_object_tracker"));
  try {
    if (!at_start.object_file.empty()) access = access.with(resolveMeshUri(at_start.object_file, findPackage));
  } catch (const MeshError&) {  // told where the object was to be loaded
  }
  return access.with(mesh_file_at_start);
}

BuiltTracker buildTracker(const ObjectSource& source, const TrackerConfig& config, const FileAccess& access) {
  BuiltTracker built;
  try {
    // A description may name its mesh relative to itself.
    const FileAccess all_access = access.with(packageFolder(source.object_file, findPackage));
    const ObjectDescription description = describe(source, all_access);
    ObjectModel model = loadObject(description, IsolatedMeshLoader(findPackage, all_access));
    built.name = frameName(source.name.empty() ? description.name : source.name, description.mesh);
    built.mesh_file = std::filesystem::absolute(resolveMeshUri(description.mesh, findPackage)).string();
    built.mesh_scale = description.mesh_scale;
    model.name = built.name;
    built.config = config;
    built.tracker = std::make_shared<ObjectTracker>(std::move(model), config);
  } catch (const std::exception& error) {
    built.tracker.reset();
    built.problem = error.what();
    if (source.object_file.empty() && built.problem.find("mesh_scale") != std::string::npos) {
      built.problem += " For a mesh without an object's YAML file that is ~mesh_scale.";
    }
  }
  return built;
}

InitFilePose loadInitFile(const std::string& uri) {
  InitFilePose result;
  try {
    const InputFile file(resolveMeshUri(uri, findPackage), kMaxInitFileBytes);
    const nlohmann::json json = nlohmann::json::parse(file.read());
    result.T_camera_object = poseFromNumbers(json.at("cam_R_m2c").get<std::vector<double>>(),
                                             json.at("cam_t_m2c").get<std::vector<double>>());
  } catch (const std::exception& error) {
    result.problem = "initial pose file '" + uri + "': " + error.what() + "; expected " + kInitFormat;
  }
  return result;
}

}  // namespace depth_object_tracker
