// SPDX-License-Identifier: BSD-3-Clause
// Pushes of an object in the hand that holds it.
#include "depth_object_tracker/simulator/hand_slips.h"

#include <algorithm>

namespace depth_object_tracker {
namespace {

constexpr std::uint64_t kStream = 108;
constexpr double kMaxOffsetM = 0.02;
constexpr double kMaxOffsetRad = 0.3;
constexpr double kFirstSlipS = 1.6;
constexpr double kComeS = 0.6;   // the pushing hand needs this long to come
constexpr double kStayS = 0.25;  // and stays this long after

double smoothStep(double x) {
  const double y = std::clamp(x, 0.0, 1.0);
  return y * y * (3.0 - 2.0 * y);
}

}  // namespace

HandSlips::HandSlips(std::uint64_t seed, const Eigen::Vector3d& pivot_object)
    : random_(seed, kStream), pivot_object_(pivot_object) {}

// The slip that is going on or comes next.
const HandSlips::Slip& HandSlips::slipAt(double t_s) {
  while (slips_.empty() || slips_.back().end_s + kStayS + 0.5 * kComeS < t_s) {
    Slip slip;
    slip.start_s = slips_.empty() ? kFirstSlipS : slips_.back().end_s + random_.uniform(1.5, 2.2);
    slip.end_s = slip.start_s + random_.uniform(0.5, 0.9);
    slip.from = slips_.empty() ? Vector6d::Zero() : slips_.back().to;
    slip.to << random_.uniform(0.5, 1.0) * kMaxOffsetM * random_.unitVector(),
        random_.uniform(0.5, 1.0) * kMaxOffsetRad * random_.unitVector();
    slips_.push_back(slip);
  }
  const auto found = std::find_if(slips_.begin(), slips_.end(),
                                  [&](const Slip& slip) { return t_s <= slip.end_s + kStayS + 0.5 * kComeS; });
  return *found;
}

Pose HandSlips::offset(double t_s) {
  const Slip& slip = slipAt(t_s);
  const double share = smoothStep((t_s - slip.start_s) / (slip.end_s - slip.start_s));
  const Vector6d delta = slip.from + share * (slip.to - slip.from);
  Pose T_grasped_object = Pose::Identity();
  T_grasped_object.linear() = expSo3(delta.tail<3>());
  T_grasped_object.translation() = pivot_object_ + delta.head<3>() - T_grasped_object.linear() * pivot_object_;
  return T_grasped_object;
}

bool HandSlips::isSlipping(double t_s) {
  const Slip& slip = slipAt(t_s);
  return t_s > slip.start_s && t_s < slip.end_s;
}

double HandSlips::pusherPresence(double t_s) {
  const Slip& slip = slipAt(t_s);
  return smoothStep((t_s - slip.start_s + kComeS) / kComeS) *
         smoothStep((slip.end_s + kStayS + 0.5 * kComeS - t_s) / (0.5 * kComeS));
}

}  // namespace depth_object_tracker
