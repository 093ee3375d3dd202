// SPDX-License-Identifier: BSD-3-Clause
// The tracker's outputs as a rosbag, under the names that the nodelet gives them.
#pragma once

#include "depth_object_tracker/ros/tracker_session.h"

#include <rosbag/bag.h>

#include <cstdint>
#include <string>

namespace depth_object_tracker {

/// Holds nothing that depends on the clock: rates, times and latency in the status are 0.
class ResultBag {
 public:
  /// @throws InputError
  explicit ResultBag(const std::string& path);

  /// @param recorded_at when the image was recorded: bags of images and results play together.
  void write(const FrameOutcome& outcome, const TrackerSession& session, const ros::Time& recorded_at);

  /// @throws InputError when something could not be written (disk full).
  void close();

 private:
  void writePose(const FrameOutcome& outcome, const std::string& object_name, const ros::Time& recorded_at);

  std::string path_;
  rosbag::Bag bag_;
  std::uint64_t num_received_ = 0, num_processed_ = 0;
};

}  // namespace depth_object_tracker
