// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/drop_watch.h"

#include <algorithm>
#include <cstdio>

namespace depth_object_tracker {
namespace {

constexpr double kMostOfInterval = 0.7;

}  // namespace

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
  const double interval_s = elapsed_s / num_received;
  const bool is_slow = frame_time_s > kMostOfInterval * interval_s;
  char text[400];
  std::snprintf(text, sizeof(text),
                "%.0f %% of the images of the last %.0f s were dropped: they come every %.1f ms and tracking one takes "
                "%.1f ms. %s",
                100.0 * dropped_share_, elapsed_s, 1e3 * interval_s, 1e3 * frame_time_s,
                is_slow ? "Lower ~tracker/frame_budget_s, num_particles or target_model_pixels, or raise num_threads"
                        : "That would do: other work keeps the processor busy, or subscribers of ~overlay, ~marker and "
                          "the particles take the rest");
  return text;
}

}  // namespace depth_object_tracker
