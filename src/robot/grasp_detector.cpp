// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/robot/grasp_detector.h"

#include <cmath>
#include <stdexcept>

namespace depth_object_tracker {
namespace {

// Shares of the way from open to closed: less is open, more has closed on nothing.
constexpr double kOpenBelow = 0.05;
constexpr double kEmptyAbove = 0.98;
constexpr double kGapS = 1.0;  // images further apart say nothing of the motion between them

}  // namespace

GraspDetector::GraspDetector(const GraspDetectorConfig& config) : config_(config) {
  if (!std::isfinite(config.closed_position - config.open_position) || config.closed_position == config.open_position) {
    throw std::invalid_argument("grasp detection: open and closed position of the gripper's joint must differ");
  }
  if (!(config.decide_after_s > 0.0 && config.max_distance_m > 0.0 && config.max_relative_speed_m_s > 0.0)) {
    throw std::invalid_argument("grasp detection: time, distance and speed must be above 0");
  }
}

void GraspDetector::setHeld(bool held) {
  held_ = held;
  disagrees_ = false;
}

bool GraspDetector::speaksForGrasp(double joint_position, const Pose& T_link_object, double dt_s) const {
  const double closed = (joint_position - config_.open_position) / (config_.closed_position - config_.open_position);
  if (!(closed >= kOpenBelow && closed <= kEmptyAbove)) return false;  // also NaN
  if (T_link_object.translation().norm() > config_.max_distance_m) return false;
  const double moved_m = (T_link_object.translation() - *last_position_link_).norm();
  return moved_m <= config_.max_relative_speed_m_s * dt_s;
}

std::optional<bool> GraspDetector::update(double stamp_s, double joint_position, const Pose& T_link_object) {
  const double dt_s = stamp_s - last_stamp_s_;
  const bool is_comparable = last_position_link_ && dt_s > 0.0 && dt_s < kGapS;
  const bool for_grasp = is_comparable && speaksForGrasp(joint_position, T_link_object, dt_s);
  last_position_link_ = T_link_object.translation();
  last_stamp_s_ = stamp_s;
  if (!is_comparable) {
    disagrees_ = false;
    return std::nullopt;
  }
  const bool disagrees = for_grasp != held_;
  if (disagrees && !disagrees_) disagrees_since_s_ = stamp_s - dt_s;
  disagrees_ = disagrees;
  if (!disagrees || stamp_s - disagrees_since_s_ < config_.decide_after_s) return std::nullopt;
  held_ = for_grasp;
  disagrees_ = false;
  return held_;
}

}  // namespace depth_object_tracker
