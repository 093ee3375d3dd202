// SPDX-License-Identifier: BSD-3-Clause
// JSON input with messages that name file, place and key.
#include "json_file.h"

#include "depth_object_tracker/tools/input_error.h"

#include <Eigen/SVD>

#include <charconv>
#include <cmath>
#include <fstream>

namespace depth_object_tracker {
namespace {

constexpr double kRotationRounding = 1e-2;  // largest deviation of R R^T from the identity that is taken for rounding

const nlohmann::json& valueAt(const nlohmann::json& object, const std::string& key, const std::string& where) {
  if (!object.is_object()) throw InputError(where + " is not a JSON object; expected {\"" + key + "\": ...}");
  const auto found = object.find(key);
  if (found == object.end()) throw InputError(where + " has no key \"" + key + "\"");
  return *found;
}

double toNumber(const nlohmann::json& value, const std::string& what) {
  if (!value.is_number()) throw InputError(what + " is not a number: " + value.dump().substr(0, 60));
  const double number = value.get<double>();
  if (!std::isfinite(number)) throw InputError(what + " is not finite");
  return number;
}

}  // namespace

nlohmann::json readJsonObject(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw InputError("cannot open " + path + ": check that the file exists and can be read");
  try {
    nlohmann::json root = nlohmann::json::parse(file);
    if (!root.is_object()) throw InputError(path + " does not hold a JSON object {...}");
    return root;
  } catch (const nlohmann::json::exception& error) {
    std::string message = error.what();
    for (char& c : message) c = c == '\n' ? ' ' : c;
    throw InputError(path + " is not valid JSON: " + message);
  }
}

double numberAt(const nlohmann::json& object, const std::string& key, const std::string& where) {
  return toNumber(valueAt(object, key, where), where + ": \"" + key + "\"");
}

std::vector<double> toNumbers(const nlohmann::json& value, std::size_t count, const std::string& what) {
  if (!value.is_array() || value.size() != count) {
    throw InputError(what + " is not a list of " + std::to_string(count) + " numbers");
  }
  std::vector<double> numbers;
  for (const nlohmann::json& entry : value) numbers.push_back(toNumber(entry, "an entry of " + what));
  return numbers;
}

std::vector<double> numbersAt(const nlohmann::json& object, const std::string& key, std::size_t count,
                              const std::string& where) {
  return toNumbers(valueAt(object, key, where), count, where + ": \"" + key + "\"");
}

Eigen::Matrix3d toRotation(const std::vector<double>& matrix, const std::string& what) {
  const Eigen::Matrix3d given = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(matrix.data());
  const bool orthonormal =
      (given * given.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < kRotationRounding;
  if (!orthonormal || given.determinant() < 0.0) {
    throw InputError(what + " is not a rotation matrix (9 numbers, row-major, orthonormal, determinant 1)");
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(given, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

Pose bopPoseAt(const nlohmann::json& object, const std::string& where) {
  constexpr double kMetresPerMillimetre = 1e-3;
  Pose T_camera_object = Pose::Identity();
  T_camera_object.linear() = toRotation(numbersAt(object, "cam_R_m2c", 9, where), where + ": \"cam_R_m2c\"");
  const std::vector<double> t_mm = numbersAt(object, "cam_t_m2c", 3, where);
  T_camera_object.translation() = kMetresPerMillimetre * Eigen::Map<const Eigen::Vector3d>(t_mm.data());
  return T_camera_object;
}

int frameNumber(const std::string& key, const std::string& where) {
  int number = -1;
  const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), number);
  if (error != std::errc() || end != key.data() + key.size() || number < 0) {
    throw InputError(where + " has the key \"" + key.substr(0, 40) + "\", which is not a frame number");
  }
  return number;
}

}  // namespace depth_object_tracker
