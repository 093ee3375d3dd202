// SPDX-License-Identifier: BSD-3-Clause
// Range and type checks of single parameters.
#include "parameter_binding.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <locale>
#include <sstream>

namespace depth_object_tracker {
namespace {

std::string formatNumber(double value) {
  // The shortest text that reads back as the same number.
  for (int precision = 6; precision <= 17; ++precision) {
    std::ostringstream stream;
    stream.imbue(std::locale::classic());
    stream.precision(precision);
    stream << value;
    std::istringstream reader(stream.str());
    reader.imbue(std::locale::classic());
    double read_back = 0.0;
    if (!std::isfinite(value) || precision == 17 || (reader >> read_back && read_back == value)) return stream.str();
  }
  return {};
}

std::string formatRange(double min, double max) {
  return "[" + formatNumber(min) + ", " + formatNumber(max) + "]";
}

/// YAML 1.1 readers, rosparam's among them, take `1e-3` (no point) for text; what reads as a number whole is one.
bool parseNumber(const std::string& text, double& number) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  return static_cast<bool>(stream >> std::noskipws >> number) &&
         stream.peek() == std::istringstream::traits_type::eof();
}

double toDouble(const std::string& name, const ParameterValue& value, double min, double max) {
  double number = std::numeric_limits<double>::quiet_NaN();
  if (const double* real = std::get_if<double>(&value)) number = *real;
  if (const int* integer = std::get_if<int>(&value)) number = *integer;
  if (const std::string* text = std::get_if<std::string>(&value)) {
    if (!parseNumber(*text, number)) number = std::numeric_limits<double>::quiet_NaN();
  }
  if (!(number >= min && number <= max)) throwOutOfRange(name, value, "a number in " + formatRange(min, max));
  return number;
}

int toInt(const std::string& name, const ParameterValue& value, int min, int max, const std::string& expected) {
  const int* integer = std::get_if<int>(&value);
  if (integer == nullptr || *integer < min || *integer > max) throwOutOfRange(name, value, expected);
  return *integer;
}

ParameterBinding makeBinding(const char* name, std::string range, const char* description,
                             std::function<ParameterValue(const TrackerConfig&)> get,
                             std::function<void(TrackerConfig&, const ParameterValue&)> set) {
  const ParameterValue default_value = get(TrackerConfig());
  return {{name, std::move(range), description, default_value}, std::move(get), std::move(set)};
}

/// Reads a field as the type by which parameters know it.
template <typename Value, typename Field>
std::function<ParameterValue(const TrackerConfig&)> getter(FieldAccess<Field> field) {
  return [field](const TrackerConfig& config) -> ParameterValue {
    TrackerConfig copy = config;
    return static_cast<Value>(field(copy));
  };
}

}  // namespace

std::string formatParameterValue(const ParameterValue& value) {
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const int* integer = std::get_if<int>(&value)) return std::to_string(*integer);
  if (const double* real = std::get_if<double>(&value)) {
    const std::string text = formatNumber(*real);
    return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;  // `n`: nan and inf
  }
  return std::get<std::string>(value);
}

void throwOutOfRange(const std::string& name, const ParameterValue& value, const std::string& expected) {
  const bool is_text = std::holds_alternative<std::string>(value);
  const std::string shown = is_text ? "'" + formatParameterValue(value) + "'" : formatParameterValue(value);
  throw std::invalid_argument("parameter `" + name + "` is " + shown + "; it must be " + expected);
}

ParameterBinding bindNumber(const char* name, FieldAccess<double> field, double min, double max,
                            const char* description) {
  return makeBinding(
      name, formatRange(min, max), description, getter<double>(field),
      [=](TrackerConfig& config, const ParameterValue& value) { field(config) = toDouble(name, value, min, max); });
}

ParameterBinding bindNumber(const char* name, FieldAccess<int> field, int min, int max, const char* description) {
  const std::string range = "[" + std::to_string(min) + ", " + std::to_string(max) + "]";
  return makeBinding(name, range, description, getter<int>(field),
                     [=](TrackerConfig& config, const ParameterValue& value) {
                       field(config) = toInt(name, value, min, max, "an integer in " + range);
                     });
}

ParameterBinding bindNumber(const char* name, FieldAccess<std::uint64_t> field, int min, int max,
                            const char* description) {
  const std::string range = "[" + std::to_string(min) + ", " + std::to_string(max) + "]";
  const auto get = [=](const TrackerConfig& config) -> ParameterValue {
    TrackerConfig copy = config;
    return static_cast<int>(std::min<std::uint64_t>(field(copy), std::numeric_limits<int>::max()));
  };
  return makeBinding(name, range, description, get, [=](TrackerConfig& config, const ParameterValue& value) {
    field(config) = static_cast<std::uint64_t>(toInt(name, value, min, max, "an integer in " + range));
  });
}

ParameterBinding bindSwitch(const char* name, FieldAccess<bool> field, const char* description) {
  return makeBinding(name, "true | false", description, getter<bool>(field),
                     [=](TrackerConfig& config, const ParameterValue& value) {
                       if (!std::holds_alternative<bool>(value)) throwOutOfRange(name, value, "true or false");
                       field(config) = std::get<bool>(value);
                     });
}

ParameterBinding bindNumberOrWord(const char* name, FieldAccess<int> field, int min, int max, const char* word,
                                  int word_value, const char* description) {
  const std::string range = "[" + std::to_string(min) + ", " + std::to_string(max) + "] | " + word;
  return makeBinding(name, range, description, getter<int>(field),
                     [=](TrackerConfig& config, const ParameterValue& value) {
                       const std::string* text = std::get_if<std::string>(&value);
                       const bool is_word = text != nullptr && *text == word;
                       field(config) = is_word ? word_value : toInt(name, value, min, max, "an integer in " + range);
                     });
}

}  // namespace depth_object_tracker
