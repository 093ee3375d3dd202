// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/illusions.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

constexpr std::size_t kMost = 32;
constexpr double kSameRad = 0.35;
constexpr double kLearntHalfLifeS = 0.5;  // slower than a handle comes into view
constexpr double kGoneHalfLifeS = 0.5, kForgottenHalfLifeS = 5.0;
constexpr double kLeastNat = 0.02;
constexpr double kMostNat = 20.0;  // what is better by more is not: it is the estimate that is contradicted

double angleBetween(const Pose& a, const Pose& b) {
  return rotationAngle(a.linear().transpose() * b.linear());
}

/// Share of a difference that is left after a while.
double left(double dt_s, double half_life_s) {
  return std::exp2(-dt_s / half_life_s);
}

}  // namespace

Illusions::Illusions() {
  illusions_.reserve(kMost);  // frames allocate nothing
}

double Illusions::known(const Pose& T_estimate_pose) const {
  double most = 0.0;
  for (const Illusion& illusion : illusions_) {
    if (angleBetween(illusion.T_estimate_pose, T_estimate_pose) < kSameRad) most = std::max(most, illusion.nat);
  }
  return most;
}

Illusions::Illusion* Illusions::find(const Pose& T_estimate_pose) {
  Illusion* nearest = nullptr;
  double least = kSameRad;
  for (Illusion& illusion : illusions_) {
    const double angle = angleBetween(illusion.T_estimate_pose, T_estimate_pose);
    if (angle >= least) continue;
    least = angle;
    nearest = &illusion;
  }
  return nearest;
}

void Illusions::learn(const Pose& T_estimate_pose, double nat, double dt_s) {
  if (!(nat > 0.0)) return fade(T_estimate_pose, nat, dt_s);
  Illusion* illusion = find(T_estimate_pose);
  if (illusion == nullptr) {
    if (illusions_.size() == kMost) return;
    illusions_.push_back({T_estimate_pose, 0.0});
    illusion = &illusions_.back();
  }
  const double now = std::min(nat, kMostNat);
  illusion->T_estimate_pose = T_estimate_pose;
  illusion->nat = now + (illusion->nat - now) * left(dt_s, now > illusion->nat ? kLearntHalfLifeS : kGoneHalfLifeS);
}

void Illusions::fade(const Pose& T_estimate_pose, double nat, double dt_s) {
  Illusion* illusion = find(T_estimate_pose);
  const double now = std::max(nat, 0.0);
  if (illusion == nullptr || now >= illusion->nat) return;
  illusion->nat = now + (illusion->nat - now) * left(dt_s, kGoneHalfLifeS);
}

void Illusions::age(double dt_s) {
  for (Illusion& illusion : illusions_) illusion.nat *= left(dt_s, kForgottenHalfLifeS);
  illusions_.erase(std::remove_if(illusions_.begin(), illusions_.end(),
                                  [](const Illusion& illusion) { return illusion.nat < kLeastNat; }),
                   illusions_.end());
}

void Illusions::moved(const Pose& T_before_now) {
  for (Illusion& illusion : illusions_) illusion.T_estimate_pose = T_before_now.inverse() * illusion.T_estimate_pose;
}

}  // namespace depth_object_tracker
