// SPDX-License-Identifier: BSD-3-Clause
// Closes the fingers of the simulated hand about an object.
#pragma once

#include "depth_object_tracker/geometry/triangle_mesh.h"
#include "depth_object_tracker/robot/robot_model.h"

#include <map>
#include <optional>
#include <string>

namespace depth_object_tracker {

/// Positions of the joints `finger_1_joint` ... `finger_3_joint` and `finger_1_spread` at which each finger touches.
using FingerPositions = std::map<std::string, double>;

/// @param model as config/robots/arm.urdf: the hand's z axis points to the object.
/// @return nullopt when a finger would close without touching, or does not open far enough.
std::optional<FingerPositions> closeFingers(const RobotModel& model, const TriangleMesh& object,
                                            const Pose& T_object_hand);

}  // namespace depth_object_tracker
