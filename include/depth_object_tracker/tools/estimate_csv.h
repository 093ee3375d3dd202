// SPDX-License-Identifier: BSD-3-Clause
// Writes estimates in BOP's result format.
#pragma once

#include "depth_object_tracker/tracker/tracker_result.h"

#include <fstream>
#include <string>

namespace depth_object_tracker {

/// `scene_id,im_id,obj_id,score,R,t,time`: R row-major, t in mm, time in s.
class EstimateCsvWriter {
 public:
  /// Opens the file and writes the header. @throws InputError
  EstimateCsvWriter(const std::string& path, int scene_id, int object_id);

  /// One row, also when the object is LOST (last pose, score 0).
  void write(int frame, const TrackerResult& result);

  /// Flushes. @throws InputError when something could not be written (disk full).
  void close();

 private:
  std::string path_;
  int scene_id_;
  int object_id_;
  std::ofstream file_;
};

}  // namespace depth_object_tracker
