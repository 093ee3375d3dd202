// SPDX-License-Identifier: BSD-3-Clause
// Reads an object's symmetries from BOP's models_info.json.
#include "depth_object_tracker/tools/bop_models_info.h"

#include "depth_object_tracker/tools/input_error.h"
#include "json_file.h"

namespace depth_object_tracker {
namespace {

SymmetryAxis readAxis(const nlohmann::json& entry, double mesh_scale, const std::string& where) {
  const std::vector<double> axis = numbersAt(entry, "axis", 3, where);
  const std::vector<double> offset = numbersAt(entry, "offset", 3, where);
  SymmetryAxis symmetry;
  symmetry.axis = Eigen::Map<const Eigen::Vector3d>(axis.data());
  if (symmetry.axis.norm() < 1e-9) throw InputError(where + ": \"axis\" has no direction (length 0)");
  symmetry.axis.normalize();
  symmetry.offset = mesh_scale * Eigen::Map<const Eigen::Vector3d>(offset.data());
  return symmetry;
}

Pose readTransform(const nlohmann::json& entry, double mesh_scale, const std::string& where) {
  const std::vector<double> m = toNumbers(entry, 16, where);
  Pose T_object_object = Pose::Identity();
  T_object_object.linear() =
      toRotation({m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]}, "the rotation of " + where);
  T_object_object.translation() = mesh_scale * Eigen::Vector3d(m[3], m[7], m[11]);
  return T_object_object;
}

const nlohmann::json& listAt(const nlohmann::json& object, const std::string& key, const std::string& where) {
  static const nlohmann::json kEmpty = nlohmann::json::array();
  const auto found = object.find(key);
  if (found == object.end()) return kEmpty;
  if (!found->is_array()) throw InputError(where + ": \"" + key + "\" is not a list");
  return *found;
}

}  // namespace

std::optional<Symmetries> loadBopSymmetries(const std::string& json_file, int object_id, double mesh_scale) {
  const nlohmann::json root = readJsonObject(json_file);
  const auto found = root.find(std::to_string(object_id));
  if (found == root.end()) return std::nullopt;
  const std::string where = json_file + ", object " + std::to_string(object_id);
  if (!found->is_object()) throw InputError(where + " is not a JSON object");

  Symmetries symmetries;
  for (const nlohmann::json& entry : listAt(*found, "symmetries_continuous", where)) {
    symmetries.continuous.push_back(readAxis(entry, mesh_scale, where + ", symmetries_continuous"));
  }
  for (const nlohmann::json& entry : listAt(*found, "symmetries_discrete", where)) {
    symmetries.discrete.push_back(readTransform(entry, mesh_scale, where + ", symmetries_discrete"));
  }
  return symmetries;
}

}  // namespace depth_object_tracker
