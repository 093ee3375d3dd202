// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/parameter_loader.h"

#include "depth_object_tracker/ros/option_reader.h"
#include "depth_object_tracker/tracker/nearest_name.h"
#include "depth_object_tracker/tracker/tracker_parameters.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>

namespace depth_object_tracker {
namespace {

std::optional<ParameterValue> toParameterValue(XmlRpc::XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return ParameterValue(static_cast<bool>(value));
    case XmlRpc::XmlRpcValue::TypeInt:
      return ParameterValue(static_cast<int>(value));
    case XmlRpc::XmlRpcValue::TypeDouble:
      return ParameterValue(static_cast<double>(value));
    case XmlRpc::XmlRpcValue::TypeString:
      return ParameterValue(static_cast<std::string>(value));
    default:
      return std::nullopt;
  }
}

/// Reads one option; leaves it alone when it is not set; a wrong type is a problem.
template <typename Value>
void readOption(const ros::NodeHandle& node, const std::string& key, const char* expected, Value& option,
                std::vector<std::string>& problems) {
  Value value{};
  if (node.getParam(key, value)) {
    option = value;
  } else if (node.hasParam(key)) {
    problems.push_back("parameter '" + node.resolveName(key) + "' must be " + expected);
  }
}

void checkRange(const ros::NodeHandle& node, const std::string& key, double value, double max,
                std::vector<std::string>& problems) {
  if (std::isfinite(value) && value >= 0.0 && value <= max) return;
  std::ostringstream problem;
  problem << "parameter '" << node.resolveName(key) << "' is " << value << "; valid range is [0, " << max << "]";
  problems.push_back(problem.str());
}

/// Adds the parameters of one map. Files have them below a key `tracker`, which may so stand below the name `tracker`
/// again.
void addParameters(XmlRpc::XmlRpcValue& map, const std::string& name, TrackerParameters& parameters) {
  if (map.getType() != XmlRpc::XmlRpcValue::TypeStruct) {
    parameters.problems.push_back("parameter '" + name + "' must be a map from parameter names to values");
    return;
  }
  const std::string below = "tracker";
  if (map.hasMember(below))
    addParameters(map[below], name + "/" + below, parameters);  // first: what stands nearer wins
  for (auto& [key, entry] : map) {
    if (key == below) continue;
    const auto parameter = toParameterValue(entry);
    if (!parameter) {
      parameters.problems.push_back("parameter '" + name + "/" + key + "' must be a number, a word, or true or false");
      continue;
    }
    try {
      setTrackerParameter(parameters.config, key, *parameter);
    } catch (const std::invalid_argument& error) {
      parameters.problems.push_back("parameter '" + name + "/" + key + "': " + error.what());
    }
  }
}

/// One sentence for each parameter right below the node that is not among `known`. Namespaces are left alone: they may
/// be a plugin's.
std::vector<std::string> findUnreadParameters(const ros::NodeHandle& node, const std::vector<std::string>& known) {
  std::vector<std::string> warnings, all;
  if (!node.getParamNames(all)) return warnings;
  const std::string prefix = node.getNamespace() + "/";
  for (const std::string& name : all) {
    if (name.compare(0, prefix.size(), prefix) != 0) continue;
    const std::string key = name.substr(prefix.size());
    if (key.find('/') != std::string::npos || std::find(known.begin(), known.end(), key) != known.end()) continue;
    warnings.push_back("parameter '" + name + "' is read by nobody; the nearest known one is '" + prefix +
                       nearestName(key, known) + "'");
  }
  return warnings;
}

}  // namespace

TrackerParameters loadTrackerParameters(XmlRpc::XmlRpcValue value, const std::string& name) {
  TrackerParameters parameters;
  if (value.valid()) addParameters(value, name, parameters);
  return parameters;
}

NodeletOptions loadNodeletOptions(const ros::NodeHandle& private_node) {
  NodeletOptions options;
  std::vector<std::string> known = {"tracker",
                                    "diagnostic_period",
                                    "robot",
                                    "urdf_file",
                                    "robot_occluder",
                                    "robot_base_frame",
                                    "joint_time_offset_s",
                                    "max_joint_age_s",
                                    "control_source",
                                    "camera_pose_source"};  // read elsewhere
  const auto read = [&](const char* key, const char* expected, auto& option) {
    known.push_back(key);
    readOption(private_node, key, expected, option, options.problems);
  };
  read("paths_from", "the path of a folder", options.paths_from);
  read("object_file", "the path of an object's YAML file", options.object.object_file);
  read("object_name", "a word", options.object.name);
  read("mesh", "the path of a mesh", options.object.mesh);
  read("mesh_scale", "a number (metres per unit of the mesh)", options.object.mesh_scale);
  read("object_folders", "a list of folders", options.object_folders);
  read("init_file", "the path of a JSON file, or the word search", options.init_file);
  read("last_pose_file", "the path of a JSON file", options.last_pose_file);
  read("interactive_marker", "true or false", options.interactive_marker);
  read("image_transport", "the name of an image transport", options.image_transport);
  read("publish_tf", "true or false", options.publish_tf);
  read("publish_diagnostics", "true or false", options.publish_diagnostics);
  read("target_frame", "the name of a frame", options.frames.target_frame);
  read("fixed_frame", "the name of a frame", options.frames.fixed_frame);
  read("transform_wait_s", "a number (seconds)", options.frames.transform_wait_s);
  checkRange(private_node, "transform_wait_s", options.frames.transform_wait_s, 1.0, options.problems);
  read("marker_use_mesh_resource", "true or false", options.marker_use_mesh_resource);
  read("share_estimates", "true or false", options.share_estimates);
  read("publish_debug", "true or false", options.publish_debug);
  read("control_wait_s", "a number (seconds)", options.control_wait_s);
  checkRange(private_node, "control_wait_s", options.control_wait_s, 1.0, options.problems);
  for (std::string* path :
       {&options.object.object_file, &options.object.mesh, &options.init_file, &options.last_pose_file}) {
    if (*path != kSearch || path != &options.init_file) *path = pathFrom(options.paths_from, *path);
  }
  options.warnings = findUnreadParameters(private_node, known);
  return options;
}

}  // namespace depth_object_tracker
