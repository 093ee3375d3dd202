// SPDX-License-Identifier: BSD-3-Clause
// Wall time of the stages of a frame; never an input of the estimate.
#pragma once

#include <chrono>

namespace depth_object_tracker {

class Stopwatch {
 public:
  /// Seconds since construction or the last call.
  double lap() {
    const Clock::time_point now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - start_).count();
    start_ = now;
    return seconds;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace depth_object_tracker
