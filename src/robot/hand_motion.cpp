// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/robot/hand_motion.h"

namespace depth_object_tracker {

ControlInput carryWithHand(const Pose& T_camera_hand_from, const Pose& T_camera_hand_to,
                           const Pose& T_camera_object_from, double dt_s) {
  ControlInput control;
  control.grasped = true;
  if (dt_s <= 0.0) return control;
  const Pose T_camera_object_to = T_camera_hand_to * T_camera_hand_from.inverse() * T_camera_object_from;
  const Vector6d twist = difference(T_camera_object_to, T_camera_object_from) / dt_s;
  control.linear_m_s = twist.head<3>();
  control.angular_rad_s = twist.tail<3>();
  return control;
}

}  // namespace depth_object_tracker
