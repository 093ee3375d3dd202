// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/rate_meter.h"

namespace depth_object_tracker {
namespace {

double seconds(RateMeter::Time from, RateMeter::Time to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace

void RateMeter::update(std::uint64_t count, Time now) {
  marks_.push_back({count, now});
  while (marks_.size() > 2 && seconds(marks_[1].time, now) > kWindowS) marks_.pop_front();
}

double RateMeter::hz() const {
  if (marks_.size() < 2) return 0.0;
  const double duration_s = seconds(marks_.front().time, marks_.back().time);
  return duration_s > 0.0 ? static_cast<double>(marks_.back().count - marks_.front().count) / duration_s : 0.0;
}

}  // namespace depth_object_tracker
