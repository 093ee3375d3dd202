// SPDX-License-Identifier: BSD-3-Clause
// main() of a test with a ROS master: callbacks run on threads of their own.
#pragma once

#include <gtest/gtest.h>
#include <ros/ros.h>

inline int runRosTests(int argc, char** argv, const char* node_name) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, node_name);
  ros::NodeHandle node;
  ros::AsyncSpinner spinner(2);
  spinner.start();
  return RUN_ALL_TESTS();
}
