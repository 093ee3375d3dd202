// SPDX-License-Identifier: BSD-3-Clause
// Remembers the last good pose in a file, to start from it next time.
#pragma once

#include "depth_object_tracker/tracker/tracker_result.h"

#include <chrono>
#include <mutex>
#include <optional>
#include <string>

namespace depth_object_tracker {

/// The file has the format of ~init_file, and the object's name besides. Functions are thread-safe.
class PoseMemory {
 public:
  explicit PoseMemory(std::string file) : file_(std::move(file)) {}

  /// Keeps the pose when it is TRACKING, well seen and fits.
  void note(const TrackerResult& result, const std::string& object_name);

  /// Writes what was noted since the last call, the old file staying whole until the new one is.
  /// @return why it cannot be written; "" when it can, or when there is nothing to write.
  std::string save();

 private:
  struct Noted {
    Pose T_camera_object;
    std::string object_name;
  };

  const std::string file_;
  std::mutex mutex_;  // guards noted_
  std::optional<Noted> noted_;
};

/// The pose of that object in such a file; nullopt when there is no file, or one of another object.
/// @param problem what is wrong with a file that is there.
std::optional<Pose> recallPose(const std::string& file, const std::string& object_name, std::string& problem);

}  // namespace depth_object_tracker
