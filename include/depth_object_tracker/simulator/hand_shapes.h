// SPDX-License-Identifier: BSD-3-Clause
// Hands and grippers whose fingers lie on an object's surface.
#pragma once

#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/geometry/triangle_mesh.h"

#include <optional>

namespace depth_object_tracker {

/// Where and how an object is held; all vectors in the object frame, axes of unit length and orthogonal.
struct GraspFrame {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();     ///< point inside of the object that is held
  Eigen::Vector3d approach = Eigen::Vector3d::UnitX();  ///< from the centre to the palm
  Eigen::Vector3d closing = Eigen::Vector3d::UnitY();   ///< fingers close along it
  Eigen::Vector3d lateral() const { return approach.cross(closing); }
};

/// A hand that moves with the object.
struct Hand {
  TriangleMesh mesh;                                     ///< object frame
  Eigen::Vector3d wrist = Eigen::Vector3d::Zero();       ///< object frame
  Eigen::Vector3d wrist_out = Eigen::Vector3d::UnitX();  ///< unit vector from the hand to its arm, object frame
};

/// Palm, four fingers and a thumb around the object; nothing when the object is too thick there.
std::optional<Hand> makeHumanHand(const TriangleMesh& object, const GraspFrame& grasp);

/// Parallel gripper, both fingers touching; nothing when it would have to open more than 12 cm or touches nothing.
std::optional<Hand> makeGripper(const TriangleMesh& object, const GraspFrame& grasp);

}  // namespace depth_object_tracker
