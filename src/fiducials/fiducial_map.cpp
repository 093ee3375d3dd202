// SPDX-License-Identifier: BSD-3-Clause
// Reads and writes fiducial files.
#include "depth_object_tracker/fiducials/fiducial_map.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <stdexcept>

namespace depth_object_tracker {
namespace {

constexpr double kMaxTagSizeM = 1.0;

[[noreturn]] void fail(const std::string& file, const std::string& what) {
  throw std::invalid_argument(file + ": " + what);
}

void checkKeys(const YAML::Node& map, const std::set<std::string>& known, const std::string& file) {
  if (!map.IsMap()) fail(file, "a map with the key `" + *known.begin() + "` is expected");
  for (const auto& entry : map) {
    const std::string key = entry.first.Scalar();
    if (known.count(key) == 0) fail(file, "`" + key + "` is not a known key");
  }
}

template <int kSize>
Eigen::Matrix<double, kSize, 1> readNumbers(const YAML::Node& tag, const char* key, const std::string& file) {
  const YAML::Node node = tag[key];
  if (!node || !node.IsSequence() || node.size() != kSize) {
    fail(file, "every tag needs `" + std::string(key) + "`, a list of " + std::to_string(kSize) + " numbers");
  }
  Eigen::Matrix<double, kSize, 1> numbers;
  for (int k = 0; k < kSize; ++k) numbers[k] = node[k].as<double>();
  if (!numbers.allFinite()) fail(file, "`" + std::string(key) + "` must be finite");
  return numbers;
}

Fiducial readTag(const YAML::Node& node, const std::string& file) {
  checkKeys(node, {"id", "size_m", "position", "orientation"}, file);
  if (!node["id"] || !node["size_m"]) fail(file, "every tag needs `id` and `size_m`");
  Fiducial tag;
  tag.id = node["id"].as<int>();
  tag.size_m = node["size_m"].as<double>();
  if (!(tag.size_m > 0.0 && tag.size_m <= kMaxTagSizeM)) {
    fail(file, "`size_m` of tag " + std::to_string(tag.id) + " must be > 0 and at most 1 (metres)");
  }
  const Eigen::Vector4d xyzw = readNumbers<4>(node, "orientation", file);
  if (std::abs(xyzw.norm() - 1.0) > 1e-3) fail(file, "`orientation` must be a unit quaternion [qx, qy, qz, qw]");
  tag.T_object_tag.linear() = Eigen::Quaterniond(xyzw[3], xyzw[0], xyzw[1], xyzw[2]).normalized().toRotationMatrix();
  tag.T_object_tag.translation() = readNumbers<3>(node, "position", file);
  return tag;
}

FiducialMap readMap(const YAML::Node& root, const std::string& file) {
  checkKeys(root, {"family", "tags"}, file);
  FiducialMap map;
  if (root["family"]) map.family = root["family"].as<std::string>();
  if (!root["tags"] || !root["tags"].IsSequence() || root["tags"].size() == 0) {
    fail(file, "`tags` must be a list of at least one tag");
  }
  for (const YAML::Node& node : root["tags"]) {
    const Fiducial tag = readTag(node, file);
    if (map.find(tag.id) != nullptr) fail(file, "tag " + std::to_string(tag.id) + " is there twice");
    map.tags.push_back(tag);
  }
  return map;
}

}  // namespace

std::array<Eigen::Vector3d, 4> Fiducial::corners() const {
  const double h = 0.5 * size_m;
  return {T_object_tag * Eigen::Vector3d(-h, h, 0.0), T_object_tag * Eigen::Vector3d(h, h, 0.0),
          T_object_tag * Eigen::Vector3d(h, -h, 0.0), T_object_tag * Eigen::Vector3d(-h, -h, 0.0)};
}

const Fiducial* FiducialMap::find(int id) const {
  const auto found = std::find_if(tags.begin(), tags.end(), [&](const Fiducial& tag) { return tag.id == id; });
  return found == tags.end() ? nullptr : &*found;
}

Eigen::Vector3d FiducialMap::centre() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Fiducial& tag : tags) sum += tag.T_object_tag.translation();
  return tags.empty() ? sum : sum / static_cast<double>(tags.size());
}

FiducialMap loadFiducialMap(const std::string& yaml_file) {
  try {
    return readMap(YAML::LoadFile(yaml_file), yaml_file);
  } catch (const YAML::BadFile&) {
    fail(yaml_file, "there is no such fiducial file");
  } catch (const YAML::Exception& error) {
    fail(yaml_file, "is no fiducial file: " + std::string(error.what()));
  }
}

void saveFiducialMap(const FiducialMap& map, const std::string& yaml_file) {
  std::ofstream file(yaml_file);
  file << "# AprilTags on the object. size_m: edge of the black square. Tag frame in the object's: x right and y down "
          "on the\n"
          "# printed side, z into the object; orientation is qx, qy, qz, qw.\n"
       << "family: " << map.family << "\ntags:\n";
  file.precision(9);
  for (const Fiducial& tag : map.tags) {
    const Eigen::Vector3d& p = tag.T_object_tag.translation();
    const Eigen::Quaterniond q(tag.T_object_tag.linear());
    file << "  - {id: " << tag.id << ", size_m: " << tag.size_m << ", position: [" << p.x() << ", " << p.y() << ", "
         << p.z() << "], orientation: [" << q.x() << ", " << q.y() << ", " << q.z() << ", " << q.w() << "]}\n";
  }
  if (!file.flush()) throw std::runtime_error("cannot write " + yaml_file);
}

}  // namespace depth_object_tracker
