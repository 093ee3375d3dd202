// SPDX-License-Identifier: BSD-3-Clause
// Where the hand really is, seen from the object that it holds.
#pragma once

#include "depth_object_tracker/geometry/pose.h"

#include <deque>
#include <optional>

namespace depth_object_tracker {

/// The hand as the kinematics have it and as the held object shows it.
struct ObservedHand {
  Pose T_link_observed = Pose::Identity();  ///< observed link in the axes of the link where the kinematics place it
  Pose T_link_object = Pose::Identity();    ///< the object in the observed link
};

/// At the grasp both are the same: what the kinematics were wrong by then cannot be told from how the object was
/// grasped. From then on the object shows how the error changes, except while it slips: then it is the object that
/// moves in the hand, and the correction stays. Not thread-safe.
class KinematicCorrection {
 public:
  /// A slip is noticed when it has gone on for about this long: what was taken for an error since is put right.
  static constexpr double kSlipDelayS = 0.2;

  /// A new grasp; the next update is its beginning.
  void reset();

  /// @param T_camera_link by the kinematics. @param T_camera_object as it is seen.
  ObservedHand update(double stamp_s, const Pose& T_camera_link, const Pose& T_camera_object, bool slipping);

 private:
  struct Sample {
    double stamp_s;
    Pose T_link_observed;
  };
  std::optional<Pose> T_link_object_;
  Pose T_link_observed_ = Pose::Identity();
  bool was_slipping_ = false;
  std::deque<Sample> recent_;
};

}  // namespace depth_object_tracker
