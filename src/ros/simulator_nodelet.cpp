// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/simulator_nodelet.h"

#include "depth_object_tracker/geometry/isolated_mesh_loader.h"
#include "depth_object_tracker/ros/object_source.h"
#include "depth_object_tracker/tracker/object_model.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>

namespace depth_object_tracker {
namespace {

constexpr double kReportPeriodS = 5.0;
constexpr double kToleratedMissShare = 0.02;

}  // namespace

SimulatorNodelet::~SimulatorNodelet() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  stopped_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void SimulatorNodelet::onInit() {
  options_ = loadSimulatorOptions(getPrivateNodeHandle());
  for (const std::string& problem : options_.problems) {
    NODELET_FATAL_STREAM(getName() << ": " << problem << ". Nothing is simulated; correct it and start again");
  }
  if (!options_.problems.empty()) return;
  const std::string name_space = ros::names::parentNamespace(getName());
  publisher_.emplace(getNodeHandle(), getPrivateNodeHandle(), name_space, options_.simulation);
  thread_ = std::thread([this] { run(); });
}

void SimulatorNodelet::run() {
  try {
    const ObjectDescription description = loadObjectDescription(resolveMeshUri(options_.object_file, findPackage));
    const ObjectModel object = loadObject(description, IsolatedMeshLoader(findPackage));
    SceneSimulator simulator(object.mesh, options_.simulation);
    NODELET_INFO_STREAM(getName() << ": simulates '" << object.name << "', scenario "
                                  << scenarioName(options_.simulation.scenario) << ", " << options_.rate_hz << " Hz");
    if (simulator.robot() != nullptr) {
      publisher_->setRobot(simulator.robot()->rootLink(), simulator.robot()->T_world_base(), RobotArm::kHandLink);
      joints_.emplace(getNodeHandle(), ros::names::parentNamespace(getName()), *simulator.robot());
    }
    publishImages(simulator);
    joints_.reset();  // before the simulator goes
  } catch (const std::exception& error) {
    joints_.reset();
    NODELET_FATAL_STREAM(getName() << ": cannot simulate: " << error.what());
  }
}

bool SimulatorNodelet::sleepUntil(const ros::Time& time) {
  // ROS time may be simulated and may stop: look at it in small steps, and wake up at once when the nodelet is to end.
  constexpr double kLongestStepS = 0.02;
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stop_ && ros::ok()) {
    const double left_s = (time - ros::Time::now()).toSec();
    if (left_s <= 0.0) return true;
    stopped_.wait_for(lock, std::chrono::duration<double>(std::min(left_s, kLongestStepS)));
  }
  return false;
}

ros::Time SimulatorNodelet::waitForTracker(SceneSimulator& simulator) {
  publisher_->publishFrames();
  publisher_->publishInitialPose(simulator.roughInitialPose(options_.init_error_m, options_.init_error_rad),
                                 options_.init_error_m, options_.init_error_rad);
  const ros::Time begin = ros::Time::now();
  const ros::Duration period(1.0 / options_.rate_hz);
  ros::Time next = begin;
  // The object rests until the tracker has its first pose, however long the other nodelets take to load.
  while (!publisher_->hasTracker() && (next - begin).toSec() < options_.wait_for_tracker_s) {
    if (!sleepUntil(next)) return next;
    simulator.setStereo(publisher_->isStereoWanted());
    publisher_->publish(simulator.render(0.0), next);
    next = std::max(next + period, ros::Time::now());
  }
  if (options_.wait_for_tracker_s > 0.0 && !publisher_->hasTracker()) {
    NODELET_WARN_STREAM(getName() << ": nobody listens to " << getPrivateNodeHandle().resolveName("initial_pose")
                                  << "; the object moves all the same");
  }
  return next;
}

void SimulatorNodelet::publishImages(SceneSimulator& simulator) {
  const ros::Time start = waitForTracker(simulator);
  if (joints_) joints_->begin(start);
  publisher_->publishGrasp(start);
  report_since_ = start;
  for (long tick = 0; sleepUntil(start + ros::Duration(static_cast<double>(tick) / options_.rate_hz));) {
    const double since_start_s = static_cast<double>(tick) / options_.rate_hz;
    const ros::Time stamp = start + ros::Duration(since_start_s);
    simulator.setStereo(publisher_->isStereoWanted());
    publisher_->publish(simulator.render(since_start_s), stamp);
    ++published_;
    const ros::Time now = ros::Time::now();
    // Ticks that have passed meanwhile are images that were not taken.
    const long due = static_cast<long>(std::floor((now - start).toSec() * options_.rate_hz));
    missed_ += static_cast<int>(std::max(0L, due - tick - 1));
    tick = std::max(tick + 1, due);
    reportRate(now);
  }
}

void SimulatorNodelet::reportRate(const ros::Time& now) {
  const double period_s = (now - report_since_).toSec();
  if (period_s < kReportPeriodS) return;
  if (missed_ > kToleratedMissShare * (published_ + missed_)) {
    NODELET_WARN_STREAM(getName() << ": cannot keep " << options_.rate_hz
                                  << " Hz on this machine: " << published_ / period_s << " Hz, " << missed_
                                  << " images left out in " << period_s << " s");
  }
  report_since_ = now;
  published_ = missed_ = 0;
}

}  // namespace depth_object_tracker
