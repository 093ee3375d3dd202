// SPDX-License-Identifier: BSD-3-Clause
// Robots for tests: the one that is shipped, and a small one with every kind of joint.
#pragma once

#include <fstream>
#include <iterator>
#include <string>

namespace depth_object_tracker {

inline std::string armFile() {
  return std::string(PROJECT_SOURCE_FOLDER) + "/config/robots/arm.urdf";
}

inline std::string armText() {
  std::ifstream file(armFile());
  return {std::istreambuf_iterator<char>(file), {}};
}

/// base -lift (prismatic)-> column -turn (continuous)-> plate -fixed-> bracket -bend (revolute)-> arm, and a follower
/// that mimics bend; axes and origins are crooked.
inline std::string oddRobotText() {
  return R"(<?xml version="1.0"?><robot name="odd">
  <link name="base"/><link name="column"/><link name="plate"/><link name="bracket"/><link name="arm"/><link name="follower"/>
  <joint name="lift" type="prismatic"><parent link="base"/><child link="column"/>
    <origin xyz="0.1 -0.2 0.3" rpy="0.1 0.2 -0.3"/><axis xyz="0 1 2"/><limit lower="0" upper="1" effort="1" velocity="1"/></joint>
  <joint name="turn" type="continuous"><parent link="column"/><child link="plate"/>
    <origin xyz="0 0 0.2" rpy="-1.2 0 2.2"/><axis xyz="1 1 0.3"/></joint>
  <joint name="weld" type="fixed"><parent link="plate"/><child link="bracket"/><origin xyz="0.05 0 0" rpy="0 -0.7 0"/></joint>
  <joint name="bend" type="revolute"><parent link="bracket"/><child link="arm"/>
    <origin xyz="0 0.4 0" rpy="3 1.5 0.2"/><axis xyz="0 0 -1"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="follow" type="revolute"><parent link="arm"/><child link="follower"/>
    <origin xyz="0.3 0 0"/><axis xyz="0 1 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/>
    <mimic joint="bend" multiplier="-0.5" offset="0.2"/></joint>
</robot>)";
}

}  // namespace depth_object_tracker
