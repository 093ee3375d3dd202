// SPDX-License-Identifier: BSD-3-Clause
// TrackerStatus from a result and the counters around it.
#pragma once

#include "depth_object_tracker/ros/frame_inbox.h"
#include "depth_object_tracker/ros/rate_meter.h"
#include "depth_object_tracker/tracker/tracker_result.h"

#include <depth_object_tracker/TrackerStatus.h>
#include <std_msgs/Header.h>

#include <string>

namespace depth_object_tracker {

/// What the nodelet counts besides the inbox.
struct FrameStatistics {
  RateMeter input_rate;
  RateMeter output_rate;
  std::uint64_t processed = 0;
  std::uint64_t published = 0;
  double latency_s = 0.0;  ///< wall clock, image callback to publish, of the last frame
};

struct StatusContext {
  std_msgs::Header header;
  std::string object_name;
  bool paused = false;
  bool grasped = false;
};

/// Numbers that are not finite become 0. The standard deviations are those of the worst direction.
TrackerStatus buildStatus(const TrackerResult& result, const StatusContext& context, const FrameStatistics& statistics,
                          const FrameInbox::Counters& counters);

}  // namespace depth_object_tracker
