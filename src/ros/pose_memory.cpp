// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/pose_memory.h"

#include "depth_object_tracker/ros/object_source.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>

namespace depth_object_tracker {
namespace {

namespace fs = std::filesystem;

constexpr double kGoodVisibleFraction = 0.3, kGoodScore = 0.7;

nlohmann::json toJson(const Pose& T_camera_object, const std::string& object_name) {
  nlohmann::json json;
  json["object"] = object_name;
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) json["cam_R_m2c"].push_back(T_camera_object.linear()(row, col));
    json["cam_t_m2c"].push_back(1000.0 * T_camera_object.translation()(row));
  }
  return json;
}

std::string nameIn(const std::string& file) {
  std::ifstream stream(file);
  const nlohmann::json json = nlohmann::json::parse(stream, nullptr, false);
  return json.is_object() && json.contains("object") && json["object"].is_string() ? json["object"].get<std::string>()
                                                                                   : "";
}

}  // namespace

void PoseMemory::note(const TrackerResult& result, const std::string& object_name) {
  const bool is_good = result.state == TrackerState::kTracking && result.visible_fraction >= kGoodVisibleFraction &&
                       result.score >= kGoodScore && isValidPose(result.T_camera_object);
  if (!is_good) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  noted_ = Noted{result.T_camera_object, object_name};
}

std::string PoseMemory::save() {
  std::optional<Noted> noted;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    noted.swap(noted_);
  }
  if (!noted) return "";
  try {
    const fs::path path(file_);
    if (path.has_parent_path()) fs::create_directories(path.parent_path());
    const std::string temporary = file_ + ".new";
    std::ofstream stream(temporary);
    stream << toJson(noted->T_camera_object, noted->object_name).dump(2) << "\n";
    stream.close();
    if (!stream) return "~last_pose_file '" + file_ + "' cannot be written: is the folder writable, the disk full?";
    fs::rename(temporary, path);
  } catch (const std::exception& error) {
    return "~last_pose_file '" + file_ + "' cannot be written: " + error.what();
  }
  return "";
}

std::optional<Pose> recallPose(const std::string& file, const std::string& object_name, std::string& problem) {
  problem.clear();
  if (!fs::exists(file)) return std::nullopt;
  const InitFilePose loaded = loadInitFile(file);
  problem = loaded.problem;
  if (!problem.empty() || nameIn(file) != object_name) return std::nullopt;
  return loaded.T_camera_object;
}

}  // namespace depth_object_tracker
