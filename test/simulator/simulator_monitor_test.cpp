// SPDX-License-Identifier: BSD-3-Clause
// The monitor pairs poses by stamp and measures their difference.
#include "depth_object_tracker/ros/simulator_monitor.h"

#include <gtest/gtest.h>

#include <cmath>

namespace depth_object_tracker {
namespace {

geometry_msgs::PoseStamped truthAt(double stamp_s, double x) {
  geometry_msgs::PoseStamped pose;
  pose.header.stamp = ros::Time(stamp_s);
  pose.pose.position.x = x;
  pose.pose.orientation.w = 1.0;
  return pose;
}

geometry_msgs::PoseWithCovarianceStamped estimateAt(double stamp_s, double x, double yaw_rad = 0.0) {
  geometry_msgs::PoseWithCovarianceStamped pose;
  pose.header.stamp = ros::Time(stamp_s);
  pose.pose.pose.position.x = x;
  pose.pose.pose.orientation.w = std::cos(0.5 * yaw_rad);
  pose.pose.pose.orientation.z = std::sin(0.5 * yaw_rad);
  return pose;
}

TEST(SimulatorMonitor, PairsByStampInWhateverOrder) {
  SimulatorMonitor monitor(Symmetries{});
  monitor.addEstimate(estimateAt(1.0, 0.102, 0.1));
  monitor.addTruth(truthAt(1.0, 0.1));
  monitor.addTruth(truthAt(2.0, 0.2));
  monitor.addTruth(truthAt(3.0, 0.3));
  monitor.addEstimate(estimateAt(3.0, 0.4));
  const auto summary = monitor.summary();
  EXPECT_EQ(summary.images, 3U);
  EXPECT_EQ(summary.estimates, 2U);
  EXPECT_EQ(summary.far_off, 1U);
  EXPECT_NEAR(summary.worst_position_m, 0.1, 1e-9);
}

TEST(SimulatorMonitor, TurnsAboutASymmetryAxisAreNoError) {
  SymmetryAxis axis;
  Symmetries symmetries;
  symmetries.continuous.push_back(axis);
  SimulatorMonitor bottle(symmetries), drill(Symmetries{});
  for (SimulatorMonitor* monitor : {&bottle, &drill}) {
    monitor->addTruth(truthAt(1.0, 0.1));
    monitor->addEstimate(estimateAt(1.0, 0.1, 0.5));
  }
  EXPECT_NEAR(bottle.summary().median_rotation_rad, 0.0, 1e-9);
  EXPECT_NEAR(drill.summary().median_rotation_rad, 0.5, 1e-9);
}

TEST(SimulatorMonitor, StatusLineTellsOfTheLastPeriodOnly) {
  SimulatorMonitor monitor(Symmetries{});
  EXPECT_NE(monitor.statusLine(1.0).find("no estimate"), std::string::npos);
  TrackerStatus status;
  status.state = TrackerStatus::TRACKING;
  status.visible_fraction = 0.5f;
  monitor.addStatus(status);
  monitor.addTruth(truthAt(1.0, 0.1));
  monitor.addEstimate(estimateAt(1.0, 0.105));
  const std::string line = monitor.statusLine(1.0);
  EXPECT_NE(line.find("TRACKING"), std::string::npos) << line;
  EXPECT_NE(line.find("5.00 mm"), std::string::npos) << line;
  EXPECT_NE(line.find("50 %"), std::string::npos) << line;
  EXPECT_NE(monitor.statusLine(1.0).find("no estimate"), std::string::npos);
}

}  // namespace
}  // namespace depth_object_tracker
