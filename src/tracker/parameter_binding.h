// SPDX-License-Identifier: BSD-3-Clause
// Ties one field of TrackerConfig to its name, range and meaning. Used by the table in tracker_parameters.cpp alone.
#pragma once

#include "depth_object_tracker/tracker/tracker_parameters.h"

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace depth_object_tracker {

struct ParameterBinding {
  ParameterInfo info;
  std::function<ParameterValue(const TrackerConfig&)> get;
  std::function<void(TrackerConfig&, const ParameterValue&)> set;  ///< @throws std::invalid_argument
};

template <typename Field>
using FieldAccess = Field& (*)(TrackerConfig&);

/// Value as a person would type it: integers bare, real numbers with a point.
std::string formatParameterValue(const ParameterValue& value);

/// "parameter `num_particles` is 0; it must be an integer in [1, 100000]".
[[noreturn]] void throwOutOfRange(const std::string& name, const ParameterValue& value, const std::string& expected);

ParameterBinding bindNumber(const char* name, FieldAccess<double> field, double min, double max,
                            const char* description);
ParameterBinding bindNumber(const char* name, FieldAccess<int> field, int min, int max, const char* description);
ParameterBinding bindNumber(const char* name, FieldAccess<std::uint64_t> field, int min, int max,
                            const char* description);
ParameterBinding bindSwitch(const char* name, FieldAccess<bool> field, const char* description);

/// An integer that may also be given as a word, which stands for `word_value`.
ParameterBinding bindNumberOrWord(const char* name, FieldAccess<int> field, int min, int max, const char* word,
                                  int word_value, const char* description);

/// An enumeration, written as one of a few words.
template <typename Enum>
ParameterBinding bindChoice(const char* name, FieldAccess<Enum> field,
                            std::vector<std::pair<const char*, Enum>> choices, const char* description) {
  std::string range;
  for (const auto& choice : choices) range += (range.empty() ? "" : " | ") + std::string(choice.first);
  ParameterBinding binding;
  binding.get = [field, choices](const TrackerConfig& config) -> ParameterValue {
    TrackerConfig copy = config;
    for (const auto& [word, value] : choices) {
      if (value == field(copy)) return std::string(word);
    }
    return std::string("invalid");
  };
  binding.set = [name, field, choices, range](TrackerConfig& config, const ParameterValue& value) {
    const std::string* text = std::get_if<std::string>(&value);
    for (const auto& [word, choice] : choices) {
      if (text != nullptr && *text == word) {
        field(config) = choice;
        return;
      }
    }
    throwOutOfRange(name, value, range);
  };
  binding.info = {name, range, description, binding.get(TrackerConfig())};
  return binding;
}

}  // namespace depth_object_tracker
