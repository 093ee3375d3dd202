// SPDX-License-Identifier: BSD-3-Clause
// The one list of parameter names, ranges and meanings, for every reader: YAML files, ROS parameters, tables in docs.
#pragma once

#include "depth_object_tracker/tracker/tracker_config.h"

#include <string>
#include <variant>
#include <vector>

namespace depth_object_tracker {

/// A value as a file or parameter server gives it.
using ParameterValue = std::variant<bool, int, double, std::string>;

struct ParameterInfo {
  std::string name;         ///< key, with its unit as suffix
  std::string valid_range;  ///< "[0.001, 10]" or "informed | process"
  std::string description;
  ParameterValue default_value;
};

/// Every parameter, in the order of config/tracker.yaml.
std::vector<ParameterInfo> listTrackerParameters();

/// Current value of a parameter. @throws std::invalid_argument for an unknown name.
ParameterValue getTrackerParameter(const TrackerConfig& config, const std::string& name);

/// Sets one parameter; an int is accepted where a double is meant.
/// @throws std::invalid_argument naming key, value, valid range and, for an unknown key, the nearest known one.
void setTrackerParameter(TrackerConfig& config, const std::string& name, const ParameterValue& value);

/// Checks every parameter's range and those that depend on each other.
/// @throws std::invalid_argument as setTrackerParameter does.
void validateTrackerConfig(const TrackerConfig& config);

/// Reads a YAML file: a flat map of parameters, or the same below a single top-level key `tracker`.
/// @throws std::invalid_argument naming the file besides what setTrackerParameter names.
TrackerConfig loadTrackerConfig(const std::string& yaml_file);

}  // namespace depth_object_tracker
