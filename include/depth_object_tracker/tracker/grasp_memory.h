// SPDX-License-Identifier: BSD-3-Clause
// Where a robot's hand had the object when it was last surely seen: what fits badly while the hand moves it is compared
// with that. A palm or a finger beside the object can fit it for a while; an object seldom turns in the hand.
#pragma once

#include "depth_object_tracker/geometry/pose.h"

#include <optional>

namespace depth_object_tracker {

class GraspMemory {
 public:
  /// Nothing is known of the grasp.
  void forget() { *this = GraspMemory(); }
  /// A pose from elsewhere, in an image in which the hand holds the object.
  void given(const Pose& T_camera_centre);
  /// Where the hand has moved it, or the camera.
  void moved(const Pose& T_camera_centre);
  /// An estimate. @param score 1 = as well as the object usually fits. @param dt_s since the last image.
  void seen(const Pose& T_camera_centre, double score, double dt_s);
  /// Whether an estimate that fits badly is to be compared now: at once, and ever more rarely where that is in vain.
  bool isDue(const Pose& T_camera_centre, double score) const;
  void compared();

  /// Of the centre; nullopt = unknown.
  const std::optional<Pose>& pose() const { return pose_; }

 private:
  bool fitsBadly(double score) const;

  std::optional<Pose> pose_;
  double score_ = 0.0;  // when it was seen
  double since_compared_s_ = 1e6, interval_s_ = 0.0;
};

}  // namespace depth_object_tracker
