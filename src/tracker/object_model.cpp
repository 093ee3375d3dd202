// SPDX-License-Identifier: BSD-3-Clause
// Reads object YAML files.
#include "depth_object_tracker/tracker/object_model.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <stdexcept>

namespace depth_object_tracker {
namespace {

/// Rounded matrices are repaired, wrong ones refused.
constexpr double kRotationTolerance = 1e-3;
constexpr std::uintmax_t kMaxObjectFileBytes = 1 << 20;

/// Where in which file a value stands; turns complaints into one readable sentence.
class Place {
 public:
  Place(std::string file, std::string key) : file_(std::move(file)), key_(std::move(key)) {}
  Place child(const std::string& key) const { return {file_, key_.empty() ? key : key_ + "." + key}; }
  Place element(std::size_t index) const { return {file_, key_ + "[" + std::to_string(index) + "]"}; }

  [[noreturn]] void fail(const std::string& what) const {
    throw std::invalid_argument(file_ + ": " + (key_.empty() ? what : "`" + key_ + "` " + what));
  }

 private:
  std::string file_;
  std::string key_;
};

void checkKeys(const YAML::Node& map, const std::vector<std::string>& known, const Place& place) {
  if (!map.IsMap()) place.fail("must be a map with the keys " + known.front() + ", ...");
  for (const auto& entry : map) {
    if (!entry.first.IsScalar()) place.fail("has a key that is not a word");
    const std::string key = entry.first.Scalar();
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    std::string list;
    for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
    place.child(key).fail("is not a known key; known are " + list);
  }
}

double readNumber(const YAML::Node& node, const Place& place) {
  double value = 0.0;
  if (!node.IsScalar() || !YAML::convert<double>::decode(node, value)) place.fail("must be a number");
  if (!std::isfinite(value)) place.fail("must be finite");
  return value;
}

template <std::size_t kSize>
std::array<double, kSize> readNumbers(const YAML::Node& node, const Place& place) {
  if (!node.IsSequence() || node.size() != kSize) place.fail("must be a list of " + std::to_string(kSize) + " numbers");
  std::array<double, kSize> numbers{};
  for (std::size_t i = 0; i < kSize; ++i) numbers[i] = readNumber(node[i], place.element(i));
  return numbers;
}

/// The value of a key that must be there.
YAML::Node require(const YAML::Node& map, const char* key, const Place& place) {
  if (!map[key]) place.child(key).fail("is missing");
  return map[key];
}

std::string readText(const YAML::Node& node, const Place& place) {
  if (!node.IsScalar() || node.Scalar().empty()) place.fail("must be a text that is not empty");
  return node.Scalar();
}

SymmetryAxis readAxis(const YAML::Node& node, double mesh_scale, const Place& place) {
  checkKeys(node, {"axis", "offset"}, place);
  SymmetryAxis symmetry;
  const auto axis = readNumbers<3>(require(node, "axis", place), place.child("axis"));
  symmetry.axis = Eigen::Vector3d(axis[0], axis[1], axis[2]);
  if (symmetry.axis.norm() < 1e-9) place.child("axis").fail("must not be zero");
  symmetry.axis.normalize();
  if (node["offset"]) {
    const auto offset = readNumbers<3>(node["offset"], place.child("offset"));
    symmetry.offset = mesh_scale * Eigen::Vector3d(offset[0], offset[1], offset[2]);
  }
  return symmetry;
}

Pose readTransform(const YAML::Node& node, double mesh_scale, const Place& place) {
  const auto numbers = readNumbers<16>(node, place);
  const Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data());
  if (!matrix.row(3).isApprox(Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)))
    place.fail("must end with the row 0 0 0 1 (row-major)");
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  const Eigen::Matrix3d gram = rotation * rotation.transpose();
  if ((gram - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > kRotationTolerance) {
    place.fail("must hold a rotation: its first three rows and columns are not orthonormal");
  }
  if (rotation.determinant() < 0.0) place.fail("must hold a rotation: it is a reflection");
  Pose T_object_object = Pose::Identity();
  T_object_object.linear() = Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
  T_object_object.translation() = mesh_scale * matrix.topRightCorner<3, 1>();
  return T_object_object;
}

Symmetries readSymmetries(const YAML::Node& node, double mesh_scale, const Place& place) {
  Symmetries symmetries;
  if (!node || node.IsNull()) return symmetries;
  checkKeys(node, {"continuous", "discrete"}, place);
  const auto read_list = [&](const char* kind, const auto& read_element, auto& elements) {
    if (!node[kind] || node[kind].IsNull()) return;
    if (!node[kind].IsSequence()) place.child(kind).fail("must be a list");
    for (std::size_t i = 0; i < node[kind].size(); ++i) {
      elements.push_back(read_element(node[kind][i], mesh_scale, place.child(kind).element(i)));
    }
  };
  read_list("continuous", readAxis, symmetries.continuous);
  read_list("discrete", readTransform, symmetries.discrete);
  return symmetries;
}

/// The name becomes a tf frame and part of file names.
void checkName(const std::string& name, const Place& place) {
  const auto is_odd = [](unsigned char letter) {
    return std::isalnum(letter) == 0 && letter != '_' && letter != '-' && letter != '.';
  };
  if (std::any_of(name.begin(), name.end(), is_odd)) {
    place.fail("is '" + name + "'; it names a tf frame: use letters, digits, '_', '-' and '.' only");
  }
}

/// A path without scheme that does not begin at the root is meant from the YAML file's folder.
std::string anchorMeshPath(const std::string& mesh, const std::string& yaml_file) {
  if (mesh.find("://") != std::string::npos || std::filesystem::path(mesh).is_absolute()) return mesh;
  return (std::filesystem::absolute(yaml_file).parent_path() / mesh).lexically_normal().string();
}

ObjectDescription readDescription(const YAML::Node& root, const std::string& yaml_file) {
  const Place place(yaml_file, "");
  checkKeys(root, {"name", "mesh", "mesh_scale", "symmetries"}, place);
  ObjectDescription description;
  description.name = readText(require(root, "name", place), place.child("name"));
  checkName(description.name, place.child("name"));
  description.mesh = anchorMeshPath(readText(require(root, "mesh", place), place.child("mesh")), yaml_file);
  if (root["mesh_scale"]) {
    description.mesh_scale = readNumber(root["mesh_scale"], place.child("mesh_scale"));
    if (description.mesh_scale <= 0.0) place.child("mesh_scale").fail("must be > 0 (metres per unit of the mesh file)");
  }
  description.symmetries = readSymmetries(root["symmetries"], description.mesh_scale, place.child("symmetries"));
  return description;
}

}  // namespace

ObjectDescription parseObjectDescription(const std::string& text, const std::string& yaml_file) {
  try {
    return readDescription(YAML::Load(text), yaml_file);
  } catch (const YAML::Exception& yaml_error) {
    throw std::invalid_argument(yaml_file + ": is not valid YAML: " + yaml_error.what());
  }
}

ObjectDescription loadObjectDescription(const std::string& yaml_file, const FileAccess& access) {
  std::string text;
  try {
    text = InputFile(yaml_file, kMaxObjectFileBytes, access).read();
  } catch (const FileError& error) {
    throw std::invalid_argument(yaml_file + ": there is no such object file that can be read: " + error.what());
  }
  return parseObjectDescription(text, yaml_file);
}

ObjectModel loadObject(const ObjectDescription& description, const PackageResolver& resolve_package) {
  return loadObject(description, [&resolve_package](const std::string& uri, double scale) {
    return loadMesh(uri, scale, resolve_package);
  });
}

ObjectModel loadObject(const ObjectDescription& description, const MeshLoader& load_mesh) {
  ObjectModel object;
  object.name = description.name;
  object.mesh = load_mesh(description.mesh, description.mesh_scale);
  object.symmetries = description.symmetries;
  return object;
}

}  // namespace depth_object_tracker
