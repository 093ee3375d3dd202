// SPDX-License-Identifier: BSD-3-Clause
// Names and speeds of the simulated scenarios.
#include "depth_object_tracker/simulator/simulation_config.h"

#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace depth_object_tracker {
namespace {

template <typename Enum, std::size_t N>
Enum fromName(const std::array<std::pair<const char*, Enum>, N>& names, const std::string& name, const char* what) {
  std::string allowed;
  for (const auto& [known, value] : names) {
    if (name == known) return value;
    allowed += (allowed.empty() ? "" : ", ") + std::string(known);
  }
  throw std::invalid_argument(std::string(what) + " is '" + name + "', must be one of: " + allowed);
}

// The first four in the enumeration's order; the last two are what the demo calls them.
constexpr std::array<std::pair<const char*, Scenario>, 6> kScenarios{{{"human", Scenario::kHuman},
                                                                      {"robot", Scenario::kRobot},
                                                                      {"slip", Scenario::kSlip},
                                                                      {"static", Scenario::kStatic},
                                                                      {"robot_secure", Scenario::kRobot},
                                                                      {"robot_slip", Scenario::kSlip}}};
constexpr std::array<std::pair<const char*, Speed>, 3> kSpeeds{
    {{"slow", Speed::kSlow}, {"medium", Speed::kMedium}, {"fast", Speed::kFast}}};
constexpr std::array<std::pair<const char*, Occluders>, 3> kOccluders{
    {{"none", Occluders::kNone}, {"passing", Occluders::kPassing}, {"full", Occluders::kFull}}};

struct PeakSpeeds {
  double linear_m_s;
  double angular_deg_s;
};

PeakSpeeds peakSpeeds(Scenario scenario, Speed speed) {
  const auto index = static_cast<std::size_t>(speed);
  constexpr std::array<PeakSpeeds, 3> kHuman{{{0.1, 30.0}, {0.4, 90.0}, {1.0, 220.0}}};
  constexpr std::array<PeakSpeeds, 3> kRobot{{{0.1, 30.0}, {0.25, 45.0}, {0.4, 90.0}}};
  if (scenario == Scenario::kStatic) return {0.0, 0.0};
  return scenario == Scenario::kHuman ? kHuman[index] : kRobot[index];
}

}  // namespace

Scenario scenarioFromName(const std::string& name) {
  return fromName(kScenarios, name, "scenario");
}
Speed speedFromName(const std::string& name) {
  return fromName(kSpeeds, name, "speed");
}
Occluders occludersFromName(const std::string& name) {
  return fromName(kOccluders, name, "occluders");
}

const char* scenarioName(Scenario scenario) {
  return kScenarios[static_cast<std::size_t>(scenario)].first;
}

double peakSpeed(Scenario scenario, Speed speed) {
  return peakSpeeds(scenario, speed).linear_m_s;
}

double peakAngularSpeed(Scenario scenario, Speed speed) {
  return peakSpeeds(scenario, speed).angular_deg_s * M_PI / 180.0;
}

}  // namespace depth_object_tracker
