// SPDX-License-Identifier: BSD-3-Clause
// The one exception of the command-line tools.
#pragma once

#include <stdexcept>

namespace depth_object_tracker {

/// Something that a user gave cannot be used: what, where and what to do, in one line. Ends a program with exit code 1.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace depth_object_tracker
