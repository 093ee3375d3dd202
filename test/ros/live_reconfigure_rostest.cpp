// SPDX-License-Identifier: BSD-3-Clause
// dynamic_reconfigure of a running nodelet: every live parameter can be set and read back, and reaches the tracker.
#include <gtest/gtest.h>

#include "rostest_main.h"
#include "tracker_harness.h"

#include "depth_object_tracker/ros/live_reconfigure.h"
#include "depth_object_tracker/tracker/live_parameters.h"
#include "depth_object_tracker/tracker/tracker_parameters.h"

#include <depth_object_tracker/LoadObject.h>
#include <dynamic_reconfigure/Reconfigure.h>

#include <algorithm>
#include <set>

namespace depth_object_tracker {
namespace {

const char* const kName = "/tracker_live";

dynamic_reconfigure::Config configOf(const TrackerLiveConfig& live) {
  dynamic_reconfigure::Config message;
  live.__toMessage__(message);
  return message;
}

/// Sets one parameter; what the server then has. The request names nothing else.
dynamic_reconfigure::Config set(const std::string& name, double value) {
  dynamic_reconfigure::Reconfigure call;
  const auto defaults = configOf(TrackerLiveConfig::__getDefault__());
  for (const auto& entry : defaults.ints) {
    if (entry.name != name) continue;
    dynamic_reconfigure::IntParameter parameter;
    parameter.name = name;
    parameter.value = static_cast<int>(value);
    call.request.config.ints.push_back(parameter);
  }
  for (const auto& entry : defaults.doubles) {
    if (entry.name != name) continue;
    dynamic_reconfigure::DoubleParameter parameter;
    parameter.name = name;
    parameter.value = value;
    call.request.config.doubles.push_back(parameter);
  }
  EXPECT_TRUE(ros::service::call(std::string(kName) + "/tracker/set_parameters", call));
  return call.response.config;
}

bool hasLogged(const Recorder<rosgraph_msgs::Log>& logs, const std::string& part) {
  const auto messages = logs.messages();
  return std::any_of(messages.begin(), messages.end(),
                     [&](const auto& log) { return log->msg.find(part) != std::string::npos; });
}

double valueIn(const dynamic_reconfigure::Config& config, const std::string& name) {
  for (const auto& entry : config.ints) {
    if (entry.name == name) return entry.value;
  }
  for (const auto& entry : config.doubles) {
    if (entry.name == name) return entry.value;
  }
  ADD_FAILURE() << "no " << name;
  return 0.0;
}

TEST(LiveReconfigure, OffersExactlyTheLiveParametersWithTheirDefaults) {
  const auto config = configOf(TrackerLiveConfig::__getDefault__());
  std::set<std::string> names;
  for (const auto& entry : config.ints) names.insert(entry.name);
  for (const auto& entry : config.doubles) names.insert(entry.name);
  EXPECT_EQ(names, std::set<std::string>(listLiveParameters().begin(), listLiveParameters().end()));
  const TrackerConfig defaults = fromLiveConfig(TrackerLiveConfig::__getDefault__(), TrackerConfig());
  for (const std::string& name : listLiveParameters()) {
    EXPECT_EQ(getTrackerParameter(defaults, name), getTrackerParameter(TrackerConfig(), name)) << name;
  }
  // The ranges are the tracker's own: their ends are accepted.
  EXPECT_NO_THROW(fromLiveConfig(TrackerLiveConfig::__getMin__(), TrackerConfig()));
  EXPECT_NO_THROW(fromLiveConfig(TrackerLiveConfig::__getMax__(), TrackerConfig()));
}

TEST(LiveReconfigure, SetsEachOfARunningTracker) {
  setGoodParameters(kName);
  ros::param::set(std::string(kName) + "/tracker/tracker/lost_after_s", 0.7);  // as a file has it
  ros::param::set(std::string(kName) + "/mesh_scael", 0.001);
  Recorder<rosgraph_msgs::Log> logs(ros::NodeHandle(), "/rosout");
  TrackerHarness tracker(kName);
  ASSERT_TRUE(tracker.isReady());
  EXPECT_TRUE(tracker.waitForLog({"/tracker_live/mesh_scael", "nearest known one is '/tracker_live/mesh_scale'"}));
  ASSERT_TRUE(ros::service::waitForService(std::string(kName) + "/tracker/set_parameters", 20000));
  double value = 0.0;
  const auto hasStartValue = [&] {
    return ros::param::get(std::string(kName) + "/tracker/lost_after_s", value) && value == 0.7;
  };
  EXPECT_TRUE(waitUntil(hasStartValue)) << value;
  ASSERT_TRUE(tracker.initialise());
  tracker.expectTracking();

  for (const std::string& name : listLiveParameters()) {
    const double wanted = name == "num_particles"         ? 55
                          : name == "target_model_pixels" ? 900
                          : name == "downsampling"        ? 3
                                                          : 0.05;
    const double legal = name == "sudden_motion_scale" ? 7.0 : wanted;
    EXPECT_EQ(valueIn(set(name, legal), name), legal) << name;
    EXPECT_TRUE(ros::param::get(std::string(kName) + "/tracker/" + name, value)) << name;
    EXPECT_EQ(value, legal) << name;
  }
  EXPECT_TRUE(waitUntil([&] { return hasLogged(logs, "num_particles: 40 -> 55"); }, 10.0 * kSlowness));
  const auto has55 = [&] { return tracker.step().num_particles == 55u; };
  EXPECT_TRUE(waitUntil(has55, 10.0 * kSlowness));

  EXPECT_EQ(valueIn(set("num_particles", -5), "num_particles"), 1) << "out of range: the nearest end, as usual there";
  set("num_particles", 40);
  set("frame_budget_s", 1e-5);
  const auto saves = [&] { return tracker.step().num_particles < 40u; };
  EXPECT_TRUE(waitUntil(saves, 10.0 * kSlowness)) << "a budget that cannot be kept";

  // What was set outlives the object.
  LoadObject call;
  ASSERT_TRUE(ros::service::call(std::string(kName) + "/load_object", call));
  ASSERT_TRUE(call.response.success) << call.response.message;
  ASSERT_TRUE(tracker.initialise());
  const auto hasKept = [&] { return tracker.step().num_particles == 40u || tracker.status()->num_particles < 40u; };
  EXPECT_TRUE(waitUntil(hasKept, 10.0 * kSlowness));
}

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  return runRosTests(argc, argv, "live_reconfigure_rostest");
}
