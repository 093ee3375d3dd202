// SPDX-License-Identifier: BSD-3-Clause
// A program started without a shell, and what it writes.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace depth_object_tracker {

struct ChildOutcome {
  std::string output;           ///< what it wrote to its standard output
  bool timed_out = false;       ///< it was killed for taking too long
  bool wrote_too_much = false;  ///< it was killed for that
  bool started = false;
  int status = 0;  ///< as of waitpid(), or of posix_spawn() when not started
};

/// Runs a program to its end.
/// @param input descriptor that becomes its standard input; its error output goes nowhere.
ChildOutcome runChild(const std::vector<std::string>& command, int input, double timeout_s, std::size_t max_output);

}  // namespace depth_object_tracker
