// SPDX-License-Identifier: BSD-3-Clause
// Writes one JSON object per frame with all that the tracker says.
#pragma once

#include "depth_object_tracker/tracker/tracker_result.h"

#include <fstream>
#include <string>

namespace depth_object_tracker {

/// JSON lines; numbers with as many digits as a double needs, null for what is not finite.
class TraceWriter {
 public:
  /// @throws InputError
  explicit TraceWriter(const std::string& path);

  void write(int frame, const TrackerResult& result);

  /// Flushes. @throws InputError when something could not be written (disk full).
  void close();

 private:
  std::string path_;
  std::ofstream file_;
};

}  // namespace depth_object_tracker
