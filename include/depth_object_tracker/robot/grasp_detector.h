// SPDX-License-Identifier: BSD-3-Clause
// Tells from the gripper's joint and the object's motion whether the robot holds the object.
#pragma once

#include "depth_object_tracker/geometry/pose.h"

#include <optional>
#include <string>

namespace depth_object_tracker {

struct GraspDetectorConfig {
  std::string link;                      ///< the hand; empty = off
  std::string joint;                     ///< of the gripper
  double open_position = 0.0;            ///< of the joint [rad or m]
  double closed_position = 1.0;          ///< with nothing in the gripper; may be less than open_position
  double decide_after_s = 0.3;           ///< so long everything must speak for it, or against
  double max_distance_m = 0.3;           ///< from the link's origin to the object's, when held
  double max_relative_speed_m_s = 0.05;  ///< of the object's origin in the hand, when held
};

/// A gripper that is closed in part, about an object that moves with it, holds it. One that opens again, or an object
/// that moves away, ends that. Not thread-safe.
class GraspDetector {
 public:
  /// @throws std::invalid_argument when open and closed are the same, or one of the limits is not above 0.
  explicit GraspDetector(const GraspDetectorConfig& config);

  /// One image in which the object was seen.
  /// @return the new state when it has changed; nullopt while it has not.
  std::optional<bool> update(double stamp_s, double joint_position, const Pose& T_link_object);

  /// Somebody who knows has said so; detection goes on from there.
  void setHeld(bool held);

  const GraspDetectorConfig& config() const { return config_; }

 private:
  bool speaksForGrasp(double joint_position, const Pose& T_link_object, double dt_s) const;

  GraspDetectorConfig config_;
  bool held_ = false;
  double disagrees_since_s_ = 0.0;
  bool disagrees_ = false;
  double last_stamp_s_ = 0.0;
  std::optional<Eigen::Vector3d> last_position_link_;
};

}  // namespace depth_object_tracker
