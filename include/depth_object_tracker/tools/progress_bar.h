// SPDX-License-Identifier: BSD-3-Clause
// A progress bar on a terminal, nothing in a pipe.
#pragma once

#include <chrono>
#include <cstddef>

namespace depth_object_tracker {

class ProgressBar {
 public:
  /// Draws on standard error when that is a terminal.
  explicit ProgressBar(std::size_t total);
  /// Clears the line.
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void update(std::size_t done);

 private:
  std::size_t total_;
  bool on_terminal_;
  std::chrono::steady_clock::time_point last_drawn_{};
};

}  // namespace depth_object_tracker
