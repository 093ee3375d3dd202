// SPDX-License-Identifier: BSD-3-Clause
// The table that doc/parameters.md should hold.
#pragma once

#include "depth_object_tracker/tracker/live_parameters.h"
#include "parameter_yaml.h"

#include <algorithm>
#include <string>

namespace depth_object_tracker {

/// A bar would end the cell.
inline std::string forCell(std::string text) {
  for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2)) text.insert(at, "\\");
  return text;
}

inline std::string renderParameterTable() {
  const auto& live = listLiveParameters();
  std::string text = "| Parameter | Default | Range | Live | Meaning |\n|---|---|---|---|---|\n";
  for (const ParameterInfo& parameter : listTrackerParameters()) {
    const bool is_live = std::find(live.begin(), live.end(), parameter.name) != live.end();
    text += "| `" + parameter.name + "` | " + formatForYaml(parameter.default_value) + " | " +
            forCell(parameter.valid_range) + " | " + (is_live ? "yes" : "") + " | " + forCell(parameter.description) +
            " |\n";
  }
  return text;
}

}  // namespace depth_object_tracker
