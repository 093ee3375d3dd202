// SPDX-License-Identifier: BSD-3-Clause
// Starts and stops: maps time to progress along a path.
#pragma once

#include "depth_object_tracker/simulator/random_source.h"

#include <vector>

namespace depth_object_tracker {

/// Progress runs at rate 1 while moving and 0 while resting, with smooth ramps between; some stops are abrupt.
/// The plan is endless and made as it is needed; any time can be asked for again. Not thread-safe.
class MotionClock {
 public:
  explicit MotionClock(std::uint64_t seed, double first_rest_s = 0.3);

  /// Progress [s] at time t_s [s]; 0 up to the end of the first rest. Non-decreasing, derivative in [0, 1].
  double progress(double t_s);

 private:
  struct Segment {
    double start_s;
    double speed_up_s;
    double cruise_s;
    double slow_down_s;
    double rest_s;
    double progress_at_start_s;
    double end() const { return start_s + speed_up_s + cruise_s + slow_down_s + rest_s; }
    double progressAt(double t_s) const;
  };
  void extendTo(double t_s);

  RandomSource random_;
  double first_rest_s_;
  std::vector<Segment> segments_;
};

}  // namespace depth_object_tracker
