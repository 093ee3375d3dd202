// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/simulator_options.h"

#include <sstream>
#include <stdexcept>

namespace depth_object_tracker {
namespace {

// The trajectory's peaks and the object's place in the view are checked over so long; it never repeats.
constexpr double kEndlessS = 600.0;
constexpr double kDemoRestS = 0.8;

/// Reads parameters of one node and notes what is wrong with them.
class ParameterReader {
 public:
  ParameterReader(const ros::NodeHandle& node, std::vector<std::string>& problems) : node_(node), problems_(problems) {}

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

}  // namespace

SimulatorOptions loadSimulatorOptions(const ros::NodeHandle& private_node) {
  SimulatorOptions options;
  options.simulation.duration_s = kEndlessS;
  options.simulation.first_rest_s = kDemoRestS;
  ParameterReader reader(private_node, options.problems);
  reader.read("object_file", "the path of an object's YAML file", options.object_file);
  if (options.object_file.empty()) {
    options.problems.push_back("parameter '" + private_node.resolveName("object_file") +
                               "' is not set; it names the object's YAML file");
  }
  reader.readName("scenario", scenarioFromName, options.simulation.scenario);
  reader.readName("speed", speedFromName, options.simulation.speed);
  reader.readName("occluders", occludersFromName, options.simulation.occluders);
  int seed = 1;
  reader.read("seed", "a whole number", seed);
  options.simulation.seed = static_cast<std::uint64_t>(seed);
  reader.readNumber("rate_hz", 1.0, 120.0, options.rate_hz);
  reader.readNumber("wait_for_tracker_s", 0.0, 3600.0, options.wait_for_tracker_s);
  reader.readNumber("init_error_m", 0.0, 1.0, options.init_error_m);
  reader.readNumber("init_error_rad", 0.0, 3.2, options.init_error_rad);
  return options;
}

}  // namespace depth_object_tracker
