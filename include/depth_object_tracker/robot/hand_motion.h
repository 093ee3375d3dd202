// SPDX-License-Identifier: BSD-3-Clause
// From the motion of the hand to the motion of what it holds.
#pragma once

#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/model/control_input.h"

namespace depth_object_tracker {

/// Mean velocity of an object that moves with the hand, such that the process model t += v dt, R = Exp(omega dt) R
/// takes it exactly to where the hand takes it.
/// @param T_camera_hand_from, T_camera_hand_to at the beginning and end of the interval, each in the camera of its own
///   time: the camera may move.
/// @param T_camera_object_from the object (mesh origin) at the beginning. @param dt_s >= 0; 0 = no motion.
ControlInput carryWithHand(const Pose& T_camera_hand_from, const Pose& T_camera_hand_to,
                           const Pose& T_camera_object_from, double dt_s);

}  // namespace depth_object_tracker
