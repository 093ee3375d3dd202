// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/grasp_memory.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

// Of an estimate: worse than this it is in doubt, and with what is little worse than when the grasp was last surely
// seen as well. A mesh that always fits badly is believed in time.
constexpr double kLeastScore = 0.8, kWorse = 0.03, kForgottenPerS = 0.02;
constexpr double kScoreOfGiven = 0.95;
constexpr double kSameM = 0.004, kSameRad = 0.07;
constexpr double kFirstIntervalS = 0.1, kLastIntervalS = 1.0;

}  // namespace

void GraspMemory::given(const Pose& T_camera_centre) {
  forget();
  pose_ = T_camera_centre;
  score_ = kScoreOfGiven;
}

void GraspMemory::moved(const Pose& T_camera_centre) {
  pose_ = T_camera_centre;
}

void GraspMemory::seen(const Pose& T_camera_centre, double score, double dt_s) {
  since_compared_s_ += dt_s;
  score_ = std::max(0.0, score_ - kForgottenPerS * dt_s);
  if (fitsBadly(score)) return;
  pose_ = T_camera_centre;
  score_ = std::min(1.0, std::max(score, score_));
  interval_s_ = 0.0;
}

bool GraspMemory::fitsBadly(double score) const {
  return score < std::max(kLeastScore, score_ - kWorse);
}

bool GraspMemory::isDue(const Pose& T_camera_centre, double score) const {
  if (!pose_ || !fitsBadly(score) || since_compared_s_ < interval_s_) return false;
  const Vector6d apart = difference(T_camera_centre, *pose_);
  return apart.head<3>().norm() > kSameM || apart.tail<3>().norm() > kSameRad;
}

void GraspMemory::compared() {
  since_compared_s_ = 0.0;
  interval_s_ = std::min(kLastIntervalS, std::max(kFirstIntervalS, 2.0 * interval_s_));
}

}  // namespace depth_object_tracker
