// SPDX-License-Identifier: BSD-3-Clause
// The text that config/tracker.yaml should hold.
#pragma once

#include "depth_object_tracker/tracker/tracker_parameters.h"

#include <sstream>
#include <string>

namespace depth_object_tracker {

inline std::string formatForYaml(const ParameterValue& value) {
  std::ostringstream stream;
  stream.precision(10);
  std::visit([&](const auto& held) { stream << std::boolalpha << held; }, value);
  // A real number keeps its point, so that every YAML reader takes it for one.
  const bool is_bare_real =
      std::holds_alternative<double>(value) && stream.str().find_first_of(".e") == std::string::npos;
  return stream.str() + (is_bare_real ? ".0" : "");
}

inline std::string renderTrackerYaml() {
  std::string text =
      "# Every parameter of the tracker with its default, meaning and valid range. Copy the ones you change.\n"
      "# Units are in the names. An unknown key or a value out of range is an error.\n"
      "tracker:\n";
  for (const ParameterInfo& parameter : listTrackerParameters()) {
    text += "  # " + parameter.description + "; " + parameter.valid_range + "\n";
    text += "  " + parameter.name + ": " + formatForYaml(parameter.default_value) + "\n";
  }
  return text;
}

}  // namespace depth_object_tracker
