// SPDX-License-Identifier: BSD-3-Clause
// JSON input with messages that name file, place and key.
#pragma once

#include "depth_object_tracker/geometry/pose.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace depth_object_tracker {

/// Parses a file whose top level is an object. @throws InputError
nlohmann::json readJsonObject(const std::string& path);

/// A finite number. `where` says what is being read, as in "scene_camera.json, frame 3". @throws InputError
double numberAt(const nlohmann::json& object, const std::string& key, const std::string& where);

/// Exactly `count` finite numbers. @throws InputError
std::vector<double> numbersAt(const nlohmann::json& object, const std::string& key, std::size_t count,
                              const std::string& where);

/// `value` as `count` finite numbers; `what` names it in messages. @throws InputError
std::vector<double> toNumbers(const nlohmann::json& value, std::size_t count, const std::string& what);

/// BOP's cam_R_m2c and cam_t_m2c [mm]. @throws InputError
Pose bopPoseAt(const nlohmann::json& object, const std::string& where);

/// Nearest rotation when `matrix` (row-major) is one up to rounding (1e-2). @throws InputError
Eigen::Matrix3d toRotation(const std::vector<double>& matrix, const std::string& what);

/// Key as a frame number >= 0. @throws InputError
int frameNumber(const std::string& key, const std::string& where);

}  // namespace depth_object_tracker
