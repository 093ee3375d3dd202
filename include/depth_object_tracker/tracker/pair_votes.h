// SPDX-License-Identifier: BSD-3-Clause
// Poses at which many pairs of an image's points lie like pairs of the object's: each pair around one point votes for
// the object's point that it may be, and for the turn about its normal (Drost, Ulrich, Navab and Ilic, CVPR 2010).
#pragma once

#include "depth_object_tracker/tracker/point_pairs.h"

#include <vector>

namespace depth_object_tracker {

class PairVotes {
 public:
  /// @param pairs must outlive the votes.
  explicit PairVotes(const PointPairs& pairs);

  /// Forgets all votes and takes a new point of the image.
  void start(const OrientedPoint& reference);

  /// Lets another point of the image vote. @param jitter as in PointPairs::layOn(), @param choice in [0, 1) between
  /// pairs alike, where they are many.
  void vote(const OrientedPoint& other, const std::array<double, 4>& jitter, double choice);

  /// Appends the T_camera_centre with most votes, at most `count`, none next to a better one.
  void bestPoses(int count, std::vector<Pose>& poses);

 private:
  float smoothed(std::size_t point, int turn) const;

  const PointPairs* pairs_;
  std::vector<Eigen::Matrix3d> axes_object_;  // of each of the object's points
  OrientedPoint reference_;
  Eigen::Matrix3d axes_reference_ = Eigen::Matrix3d::Identity();
  std::vector<float> votes_;  // [point][turn]
  struct Peak {
    float votes;
    std::size_t point;
    int turn;
  };
  std::vector<Peak> peaks_;  // scratch
};

}  // namespace depth_object_tracker
