// SPDX-License-Identifier: BSD-3-Clause
// demo_monitor: one line a second about how well the tracker follows the simulated object.
#include "depth_object_tracker/ros/object_source.h"
#include "depth_object_tracker/ros/simulator_monitor.h"

#include <ros/ros.h>

#include <cmath>
#include <cstdio>
#include <exception>

namespace dot = depth_object_tracker;

namespace {

// Error is not asked for before the tracker has had its first images.
constexpr double kPeriodS = 1.0;

void print(const std::string& line) {
  std::printf("%s\n", line.c_str());
  std::fflush(stdout);
}

int summarise(const dot::SimulatorMonitor& monitor) {
  const auto summary = monitor.summary();
  char line[256];
  std::snprintf(line, sizeof(line),
                "summary: %zu images, %zu estimates; median error %.2f mm, %.2f deg; worst %.1f mm; %zu over %.0f mm",
                summary.images, summary.estimates, 1000.0 * summary.median_position_m,
                summary.median_rotation_rad * 180.0 / M_PI, 1000.0 * summary.worst_position_m, summary.far_off,
                1000.0 * dot::SimulatorMonitor::kFarOffM);
  print(line);
  return summary.estimates > 0 && summary.far_off == 0 ? 0 : 1;
}

int run() {
  ros::NodeHandle node, private_node("~");
  dot::Symmetries symmetries;
  std::string object_file;
  if (private_node.getParam("object_file", object_file)) {
    symmetries = dot::loadObjectDescription(dot::resolveMeshUri(object_file, dot::findPackage)).symmetries;
  }
  const double duration_s = private_node.param("duration_s", 0.0);
  dot::SimulatorMonitor monitor(symmetries);
  const auto truth = node.subscribe("ground_truth/pose", 100, &dot::SimulatorMonitor::addTruth, &monitor);
  const auto estimate = node.subscribe("tracker/pose", 100, &dot::SimulatorMonitor::addEstimate, &monitor);
  const auto status = node.subscribe("tracker/status", 10, &dot::SimulatorMonitor::addStatus, &monitor);
  const ros::WallTime begin = ros::WallTime::now();
  const ros::WallTimer timer = node.createWallTimer(ros::WallDuration(kPeriodS), [&](const ros::WallTimerEvent& event) {
    print(monitor.statusLine(kPeriodS));
    if (duration_s > 0.0 && (event.current_real - begin).toSec() > duration_s) ros::shutdown();
  });
  ros::spin();
  return summarise(monitor);
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "demo_monitor");
  try {
    return run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: demo_monitor: %s\n", error.what());
    return 1;
  }
}
