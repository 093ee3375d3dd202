// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/simulator_monitor.h"

#include "depth_object_tracker/tracker/tracker_result.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace depth_object_tracker {
namespace {

Pose fromMessage(const geometry_msgs::Pose& message) {
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(message.position.x, message.position.y, message.position.z);
  pose.linear() =
      Eigen::Quaterniond(message.orientation.w, message.orientation.x, message.orientation.y, message.orientation.z)
          .normalized()
          .toRotationMatrix();
  return pose;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double degrees(double rad) {
  return rad * 180.0 / M_PI;
}

}  // namespace

void SimulatorMonitor::addTruth(const geometry_msgs::PoseStamped& pose) {
  ++num_truths_;
  truths_[pose.header.stamp] = fromMessage(pose.pose);
  pair(pose.header.stamp);
}

void SimulatorMonitor::addEstimate(const geometry_msgs::PoseWithCovarianceStamped& pose) {
  estimates_[pose.header.stamp] = fromMessage(pose.pose.pose);
  pair(pose.header.stamp);
}

void SimulatorMonitor::pair(const ros::Time& stamp) {
  const auto truth = truths_.find(stamp), estimate = estimates_.find(stamp);
  if (truth != truths_.end() && estimate != estimates_.end()) {
    errors_.push_back(errorOf(estimate->second, truth->second));
    truths_.erase(truth);
    estimates_.erase(estimate);
  }
  for (Stamped* waiting : {&truths_, &estimates_}) {
    while (waiting->size() > kKept) waiting->erase(waiting->begin());
  }
}

SimulatorMonitor::Error SimulatorMonitor::errorOf(const Pose& T_camera_estimate, const Pose& T_camera_truth) const {
  const Pose T_camera_folded = foldOntoReference(T_camera_estimate, T_camera_truth, symmetries_);
  const Vector6d error = difference(T_camera_folded, T_camera_truth);
  return {error.head<3>().norm(), error.tail<3>().norm()};
}

std::string SimulatorMonitor::statusLine(double period_s) {
  char line[256];
  const char* state = status_ ? stateName(static_cast<TrackerState>(status_->state)) : "NO STATUS";
  const std::size_t count = errors_.size() - reported_;
  if (count == 0) {
    std::snprintf(line, sizeof(line), "%-13s no estimate in the last %.0f s", state, period_s);
    return line + (status_ && !status_->reason.empty() ? ": " + status_->reason : std::string());
  }
  std::vector<double> position, rotation;
  for (; reported_ < errors_.size(); ++reported_) {
    position.push_back(1000.0 * errors_[reported_].position_m);
    rotation.push_back(degrees(errors_[reported_].rotation_rad));
  }
  std::snprintf(line, sizeof(line), "%-13s error %6.2f mm %6.2f deg (worst %.1f mm)   visible %3.0f %%   %4.1f Hz",
                state, median(position), median(rotation), *std::max_element(position.begin(), position.end()),
                status_ ? 100.0 * status_->visible_fraction : 0.0, static_cast<double>(count) / period_s);
  return line;
}

SimulatorMonitor::Summary SimulatorMonitor::summary() const {
  Summary summary;
  summary.images = num_truths_;
  summary.estimates = errors_.size();
  std::vector<double> position, rotation;
  for (const Error& error : errors_) {
    position.push_back(error.position_m);
    rotation.push_back(error.rotation_rad);
    summary.far_off += error.position_m > kFarOffM ? 1U : 0U;
    summary.worst_position_m = std::max(summary.worst_position_m, error.position_m);
  }
  summary.median_position_m = median(position);
  summary.median_rotation_rad = median(rotation);
  return summary;
}

}  // namespace depth_object_tracker
