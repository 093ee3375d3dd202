// SPDX-License-Identifier: BSD-3-Clause
// Starts and stops of a simulated motion.
#include "depth_object_tracker/simulator/motion_clock.h"

#include <algorithm>

namespace depth_object_tracker {
namespace {

constexpr std::uint64_t kStream = 101;

// Integral over [0, x] of the smooth step 3 y^2 - 2 y^3, x in [0, 1].
double rampIntegral(double x) {
  return x * x * x * (1.0 - 0.5 * x);
}

}  // namespace

MotionClock::MotionClock(std::uint64_t seed, double first_rest_s)
    : random_(seed, kStream), first_rest_s_(first_rest_s) {}

double MotionClock::Segment::progressAt(double t_s) const {
  double t = t_s - start_s;
  double progress = progress_at_start_s + speed_up_s * rampIntegral(std::clamp(t / speed_up_s, 0.0, 1.0));
  t -= speed_up_s;
  progress += std::clamp(t, 0.0, cruise_s);
  t -= cruise_s;
  const double left = std::clamp(1.0 - t / slow_down_s, 0.0, 1.0);
  return progress + slow_down_s * (0.5 - rampIntegral(left));
}

double MotionClock::progress(double t_s) {
  if (t_s <= first_rest_s_) return 0.0;
  extendTo(t_s);
  const auto after = std::upper_bound(segments_.begin(), segments_.end(), t_s,
                                      [](double t, const Segment& segment) { return t < segment.start_s; });
  return std::prev(after)->progressAt(t_s);
}

void MotionClock::extendTo(double t_s) {
  while (segments_.empty() || segments_.back().end() < t_s) {
    Segment next{};
    if (segments_.empty()) {
      next.start_s = first_rest_s_;
    } else {
      next.start_s = segments_.back().end();
      next.progress_at_start_s = segments_.back().progressAt(next.start_s);
    }
    const bool abrupt = random_.uniform() < 0.4;
    next.speed_up_s = random_.uniform(0.2, 0.45);
    next.cruise_s = random_.uniform(1.8, 4.5);
    next.slow_down_s = abrupt ? 0.07 : random_.uniform(0.2, 0.4);
    next.rest_s = random_.uniform(0.2, 0.7);
    segments_.push_back(next);
  }
}

}  // namespace depth_object_tracker
