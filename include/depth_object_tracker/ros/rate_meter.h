// SPDX-License-Identifier: BSD-3-Clause
// Rate of events over the last seconds, by wall clock.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>

namespace depth_object_tracker {

/// Not thread-safe.
class RateMeter {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr double kWindowS = 2.0;

  /// @param count of the events so far, which need not come one by one.
  void update(std::uint64_t count, Time now);

  /// Events per second over the window; 0 until two updates.
  double hz() const;

 private:
  struct Mark {
    std::uint64_t count;
    Time time;
  };
  std::deque<Mark> marks_;
};

}  // namespace depth_object_tracker
