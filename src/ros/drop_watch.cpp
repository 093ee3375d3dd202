// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/drop_watch.h"

#include <algorithm>
#include <cstdio>

namespace depth_object_tracker {

std::string DropWatch::update(std::uint64_t received, std::uint64_t dropped, double frame_time_s, Time now) {
  const double elapsed_s = std::chrono::duration<double>(now - window_begin_).count();
  if (started_ && elapsed_s < kWindowS) return "";
  const double num_received = static_cast<double>(received - received_);
  dropped_share_ =
      started_ && num_received > 0.0 ? std::min(1.0, static_cast<double>(dropped - dropped_) / num_received) : 0.0;
  started_ = true;
  window_begin_ = now;
  received_ = received;
  dropped_ = dropped;
  if (dropped_share_ <= kTolerableShare) return "";
  char text[400];
  std::snprintf(text, sizeof(text),
                "%.0f %% of the images of the last %.0f s were dropped: they come every %.1f ms and one takes %.1f ms. "
                "Lower ~tracker/frame_budget_s, num_particles or target_model_pixels, raise num_threads, or free the "
                "processor",
                100.0 * dropped_share_, elapsed_s, 1e3 * elapsed_s / num_received, 1e3 * frame_time_s);
  return text;
}

}  // namespace depth_object_tracker
