// SPDX-License-Identifier: BSD-3-Clause
// Reads parameters of one node and notes what is wrong with them.
#pragma once

#include <ros/node_handle.h>

#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace depth_object_tracker {

/// Relative paths are meant from `folder`, where that is given; absolute ones and URIs stay as they are.
inline std::string pathFrom(const std::string& folder, const std::string& path) {
  const bool is_relative = !path.empty() && path.front() != '/' && path.find("://") == std::string::npos;
  return is_relative && !folder.empty() ? folder + "/" + path : path;
}

/// Options that are not set stay as they are; a wrong type or value is a problem, one sentence that names the
/// parameter.
class OptionReader {
 public:
  /// Both outlive the reader.
  OptionReader(const ros::NodeHandle& node, std::vector<std::string>& problems) : node_(node), problems_(problems) {}

  template <typename Value>
  void read(const std::string& key, const char* expected, Value& option) {
    Value value{};
    if (node_.getParam(key, value)) {
      option = value;
    } else if (node_.hasParam(key)) {
      problems_.push_back("parameter '" + node_.resolveName(key) + "' must be " + expected);
    }
  }

  void readNumber(const std::string& key, double low, double high, double& option) {
    read(key, "a number", option);
    if (option >= low && option <= high) return;
    std::ostringstream problem;
    problem << "parameter '" << node_.resolveName(key) << "' is " << option << "; valid range is [" << low << ", "
            << high << "]";
    problems_.push_back(problem.str());
  }

  /// @param parse throws std::invalid_argument with the allowed words.
  template <typename Enum>
  void readName(const std::string& key, Enum (*parse)(const std::string&), Enum& option) {
    std::string name;
    read(key, "a word", name);
    if (name.empty()) return;
    try {
      option = parse(name);
    } catch (const std::invalid_argument& error) {
      problems_.push_back("parameter '" + node_.resolveName(key) + "': " + error.what());
    }
  }

 private:
  const ros::NodeHandle& node_;
  std::vector<std::string>& problems_;
};

}  // namespace depth_object_tracker
