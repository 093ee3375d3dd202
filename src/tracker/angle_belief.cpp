// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/angle_belief.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

constexpr double kStepRad = 2.0 * M_PI / AngleBelief::kSteps;
constexpr double kMostTapShare = 0.3;  // of a step's share that goes to either side at once
constexpr double kAnythingShare = 1e-5;
constexpr double kLeastDirected = 0.2;

}  // namespace

double wrappedAngle(double angle_rad) {
  return angle_rad - 2.0 * M_PI * std::floor((angle_rad + M_PI) / (2.0 * M_PI));
}

double AngleBelief::angleOf(int step) const {
  return wrappedAngle(step * kStepRad - estimate_rad_);
}

void AngleBelief::restart(double stddev_rad) {
  constexpr double kAnyRad = 2.0;
  estimate_rad_ = 0.0;
  share_.fill(0.0);
  share_[0] = 1.0;
  if (stddev_rad > kAnyRad) {
    share_.fill(1.0 / kSteps);
  } else {
    diffuse(stddev_rad * stddev_rad);
  }
}

void AngleBelief::turnEstimate(double angle_rad) {
  estimate_rad_ = wrappedAngle(estimate_rad_ + angle_rad);
}

void AngleBelief::diffuse(double variance) {
  double tap = 0.5 * variance / (kStepRad * kStepRad);
  while (tap > 0.0) {
    const double now = std::min(tap, kMostTapShare);
    const std::array<double, kSteps> before = share_;
    for (std::size_t k = 0; k < kSteps; ++k) {
      share_[k] += now * (before[(k + 1) % kSteps] + before[(k + kSteps - 1) % kSteps] - 2.0 * before[k]);
    }
    tap -= now;
  }
}

void AngleBelief::weigh(const std::function<double(double)>& against) {
  for (int k = 0; k < kSteps; ++k) share_[static_cast<std::size_t>(k)] *= std::exp(-against(angleOf(k)));
  normalise();
}

void AngleBelief::normalise() {
  double sum = 0.0;
  for (const double share : share_) sum += share;
  for (double& share : share_) share = (1.0 - kAnythingShare) * share / sum + kAnythingShare / kSteps;
}

double AngleBelief::near(double angle_rad) const {
  const int step = static_cast<int>(std::lround((angle_rad + estimate_rad_) / kStepRad));
  return share_[static_cast<std::size_t>((step % kSteps + kSteps) % kSteps)];
}

AngleBelief::Moments AngleBelief::moments() const {
  double x = 0.0, y = 0.0;
  for (int k = 0; k < kSteps; ++k) {
    x += share_[static_cast<std::size_t>(k)] * std::cos(angleOf(k));
    y += share_[static_cast<std::size_t>(k)] * std::sin(angleOf(k));
  }
  Moments moments;
  if (std::hypot(x, y) > kLeastDirected) moments.mean = std::atan2(y, x);
  for (int k = 0; k < kSteps; ++k) {
    const double off = wrappedAngle(angleOf(k) - moments.mean);
    moments.variance += share_[static_cast<std::size_t>(k)] * off * off;
  }
  return moments;
}

}  // namespace depth_object_tracker
