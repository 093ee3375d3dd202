// SPDX-License-Identifier: BSD-3-Clause
// An arm of two links from a wrist that moves to a shoulder that stays.
#pragma once

#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/geometry/triangle_mesh.h"

#include <array>

namespace depth_object_tracker {

struct ArmConfig {
  Eigen::Vector3d shoulder_camera = Eigen::Vector3d::Zero();  ///< the upper link points there
  double forearm_m = 0.27;
  double upper_arm_m = 0.6;
  double wrist_radius_m = 0.027;
  double elbow_radius_m = 0.045;
};

/// Forearm and upper arm as surfaces of revolution; they bend at the elbow as the wrist moves.
class Arm {
 public:
  explicit Arm(const ArmConfig& config);

  /// Meshes of forearm and upper arm, each along the z axis of its own frame.
  const std::array<TriangleMesh, 2>& meshes() const { return meshes_; }

  /// Poses of the two links. @param wrist_camera, wrist_out_camera where the hand ends and the unit vector out of it.
  std::array<Pose, 2> place(const Eigen::Vector3d& wrist_camera, const Eigen::Vector3d& wrist_out_camera) const;

 private:
  ArmConfig config_;
  std::array<TriangleMesh, 2> meshes_;
};

}  // namespace depth_object_tracker
