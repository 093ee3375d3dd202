// SPDX-License-Identifier: BSD-3-Clause
// Clock and medians of the benchmarks.
#pragma once

#include <algorithm>
#include <chrono>
#include <ctime>
#include <vector>

namespace depth_object_tracker {

using BenchmarkClock = std::chrono::steady_clock;

inline double secondsBetween(BenchmarkClock::time_point begin, BenchmarkClock::time_point end) {
  return std::chrono::duration<double>(end - begin).count();
}

/// What all threads of this process have worked so far: others that use the machine do not count.
inline double processorSeconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Upper median. @param values not empty.
inline double medianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace depth_object_tracker
