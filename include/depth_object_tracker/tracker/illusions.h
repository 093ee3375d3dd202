// SPDX-License-Identifier: BSD-3-Clause
// Poses that explain the image better than the right one does: with a finger where the mug's handle could be.
#pragma once

#include "depth_object_tracker/geometry/pose.h"

#include <vector>

namespace depth_object_tracker {

/// What spoke for poses at times when they could not be right. As long as it is still there (a finger moves with what
/// the hand holds) it says no more than it did then; only what comes on top is evidence.
class Illusions {
 public:
  Illusions();

  /// @return evidence [nat] for a pose, T_estimate_pose, that is known to be none; 0 or more.
  double known(const Pose& T_estimate_pose) const;

  /// An image speaks for a pose that cannot be right. @param nat evidence, tempered. @param dt_s since the last image.
  void learn(const Pose& T_estimate_pose, double nat, double dt_s);

  /// An image speaks less for a pose than before. Arguments as of learn().
  void fade(const Pose& T_estimate_pose, double nat, double dt_s);

  /// Time passes.
  void age(double dt_s);

  /// The estimate was moved by a motion in its own axes: the illusions stay where they are.
  void moved(const Pose& T_before_now);

  void clear() { illusions_.clear(); }

 private:
  struct Illusion {
    Pose T_estimate_pose;
    double nat;
  };
  /// @return the nearest one, or none.
  Illusion* find(const Pose& T_estimate_pose);

  std::vector<Illusion> illusions_;
};

}  // namespace depth_object_tracker
