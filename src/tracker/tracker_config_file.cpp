// SPDX-License-Identifier: BSD-3-Clause
// Reads the tracker's parameters from YAML files.
#include "depth_object_tracker/tracker/tracker_parameters.h"

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <limits>
#include <set>
#include <stdexcept>

namespace depth_object_tracker {
namespace {

/// Integers only in plain decimal: `010` and `0x10` mean different things to different readers.
bool parseInteger(const std::string& text, int& integer) {
  const std::size_t first_digit = text[0] == '-' || text[0] == '+' ? 1 : 0;
  if (text.size() == first_digit || text.size() > first_digit + 10) return false;
  if (text.find_first_not_of("0123456789", first_digit) != std::string::npos) return false;
  if (text[first_digit] == '0' && text.size() > first_digit + 1) return false;
  const long long value = std::stoll(text);
  if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max()) return false;
  integer = static_cast<int>(value);
  return true;
}

ParameterValue parseScalar(const YAML::Node& node) {
  const std::string& text = node.Scalar();
  const bool is_quoted = node.Tag() == "!";
  if (is_quoted || text.empty()) return text;
  if (text == "true" || text == "false") return text == "true";
  int integer = 0;
  if (parseInteger(text, integer)) return integer;
  const bool looks_numeric =
      text.find_first_not_of("+-.0123456789eE") == std::string::npos || text.back() == 'f' || text.back() == 'N';
  double real = 0.0;
  if (looks_numeric && YAML::convert<double>::decode(node, real)) return real;
  return text;
}

TrackerConfig readParameters(const YAML::Node& root) {
  TrackerConfig config;
  if (root.IsNull()) return config;
  const bool is_wrapped = root.IsMap() && root.size() == 1 && root["tracker"];
  const YAML::Node parameters = is_wrapped ? root["tracker"] : root;
  if (parameters.IsNull()) return config;
  if (!parameters.IsMap()) throw std::invalid_argument("expected a map of parameters, `name: value` line by line");
  std::set<std::string> seen;
  for (const auto& entry : parameters) {
    if (!entry.first.IsScalar()) throw std::invalid_argument("found a key that is not a word");
    const std::string name = entry.first.Scalar();
    if (!seen.insert(name).second) throw std::invalid_argument("parameter `" + name + "` is given twice");
    getTrackerParameter(config, name);  // an unknown name is the better complaint than a strange value
    if (!entry.second.IsScalar()) throw std::invalid_argument("parameter `" + name + "` must be a single value");
    setTrackerParameter(config, name, parseScalar(entry.second));
  }
  validateTrackerConfig(config);
  return config;
}

}  // namespace

TrackerConfig loadTrackerConfig(const std::string& yaml_file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(yaml_file, error)) {
    throw std::invalid_argument(yaml_file + ": there is no such parameter file");
  }
  try {
    return readParameters(YAML::LoadFile(yaml_file));
  } catch (const YAML::Exception& yaml_error) {
    throw std::invalid_argument(yaml_file + ": is not valid YAML: " + yaml_error.what());
  } catch (const std::invalid_argument& problem) {
    throw std::invalid_argument(yaml_file + ": " + problem.what());
  }
}

}  // namespace depth_object_tracker
