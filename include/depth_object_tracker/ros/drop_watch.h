// SPDX-License-Identifier: BSD-3-Clause
// Notices when many images are dropped, and says what to do about it.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace depth_object_tracker {

/// Not thread-safe.
class DropWatch {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr double kWindowS = 5.0;
  static constexpr double kTolerableShare = 0.2;

  /// @param received, dropped images so far. @param frame_time_s of the last one.
  /// @return at the end of a window with too many drops a sentence with advice, else "".
  std::string update(std::uint64_t received, std::uint64_t dropped, double frame_time_s, Time now);

  /// Share of the last full window's images that were dropped, in [0, 1].
  double droppedShare() const { return dropped_share_; }

 private:
  bool started_ = false;
  Time window_begin_;
  std::uint64_t received_ = 0, dropped_ = 0;  // when the window began
  double dropped_share_ = 0.0;
};

}  // namespace depth_object_tracker
