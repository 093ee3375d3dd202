// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/robot/kinematic_correction.h"

namespace depth_object_tracker {

void KinematicCorrection::reset() {
  *this = KinematicCorrection();
}

ObservedHand KinematicCorrection::update(double stamp_s, const Pose& T_camera_link, const Pose& T_camera_object,
                                         bool slipping) {
  const Pose T_link_object = T_camera_link.inverse() * T_camera_object;
  if (!T_link_object_) T_link_object_ = T_link_object;
  if (slipping) {
    if (!was_slipping_ && !recent_.empty()) T_link_observed_ = recent_.front().T_link_observed;
    T_link_object_ = T_link_observed_.inverse() * T_link_object;
  } else {
    T_link_observed_ = T_link_object * T_link_object_->inverse();
    recent_.push_back({stamp_s, T_link_observed_});
    while (recent_.front().stamp_s < stamp_s - kSlipDelayS) recent_.pop_front();
  }
  was_slipping_ = slipping;
  return {T_link_observed_, *T_link_object_};
}

}  // namespace depth_object_tracker
