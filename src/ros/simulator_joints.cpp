// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/simulator_joints.h"

#include <ros/names.h>
#include <ros/time.h>
#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <limits>

namespace depth_object_tracker {
namespace {

constexpr double kLongestLagS = 0.1;  // what is later than this is left out
constexpr std::chrono::milliseconds kSleep{2};

}  // namespace

SimulatorJoints::SimulatorJoints(ros::NodeHandle node, const std::string& name_space, RobotArm& robot)
    : robot_(robot),
      states_(node.advertise<sensor_msgs::JointState>(ros::names::append(name_space, "joint_states"), 100)),
      commands_(node.advertise<sensor_msgs::JointState>(ros::names::append(name_space, "joint_commands"), 100)),
      start_s_(std::numeric_limits<double>::infinity()),
      thread_([this] { run(); }) {}

SimulatorJoints::~SimulatorJoints() {
  stop_ = true;
  thread_.join();
}

void SimulatorJoints::run() {
  try {
    double last_s = ros::Time::now().toSec();
    while (!stop_ && ros::ok()) {
      const double now_s = ros::Time::now().toSec();
      if (now_s < last_s || now_s > last_s + kLongestLagS) last_s = now_s;  // the clock was set, or we are late
      for (; last_s + 1.0 / kRateHz <= now_s; last_s += 1.0 / kRateHz) publish(last_s + 1.0 / kRateHz);
      std::this_thread::sleep_for(kSleep);
    }
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM("simulated joints have stopped: " << error.what());
  }
}

void SimulatorJoints::publish(double stamp_s) {
  const SimulatedJoints joints = robot_.joints(std::max(0.0, stamp_s - start_s_));
  sensor_msgs::JointState message;
  message.header.stamp = ros::Time(stamp_s);
  message.name = joints.names;
  message.position = joints.positions;
  message.velocity = joints.velocities;
  states_.publish(message);
  message.position.clear();
  message.velocity = joints.commands;
  commands_.publish(message);
}

}  // namespace depth_object_tracker
