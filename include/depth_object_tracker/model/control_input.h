// SPDX-License-Identifier: BSD-3-Clause
// What the robot says about the object's motion.
#pragma once

#include <Eigen/Core>

namespace depth_object_tracker {

/// Mean motion of a held object over the interval between two images, optical-frame axes.
struct ControlInput {
  bool grasped = false;
  bool has_twist = true;  ///< false: held, but nothing is known of the motion (stale joints): as if nobody held it
  Eigen::Vector3d linear_m_s = Eigen::Vector3d::Zero();     ///< velocity of the mesh origin
  Eigen::Vector3d angular_rad_s = Eigen::Vector3d::Zero();  ///< angular velocity

  /// True when the object is expected to move as the robot says.
  bool isFollowed() const { return grasped && has_twist; }
};

}  // namespace depth_object_tracker
