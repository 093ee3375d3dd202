// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/camera/device_clock.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {

void DeviceClock::restart(double device_s, double offset_s) {
  is_running_ = true;
  offset_s_ = offset_s;
  begin_s_ = window_begin_s_ = device_s;
  shortest_s_.fill(offset_s);
}

double DeviceClock::shortest() const {
  return std::min(shortest_s_[0], shortest_s_[1]);
}

double DeviceClock::toReceiverTime(double device_s, double arrival_s) {
  const double sample_s = arrival_s - device_s;
  const double elapsed_s = device_s - last_device_s_;
  const bool has_jumped = elapsed_s < 0.0 || std::abs(sample_s - offset_s_) > kJumpS;
  if (!is_running_ || has_jumped) {
    // After a jump of the receiver's clock backwards, older stamps are no measure any more.
    if (arrival_s < last_stamp_s_ - kJumpS) last_stamp_s_ = -std::numeric_limits<double>::infinity();
    restart(device_s, sample_s);
  } else {
    if (device_s - window_begin_s_ > kWindowS) {
      window_begin_s_ = device_s;
      shortest_s_ = {sample_s, shortest_s_[0]};
    }
    shortest_s_[0] = std::min(shortest_s_[0], sample_s);
    // At first nothing is known yet, and the first image is often very late.
    const double max_step_s = device_s - begin_s_ < kSettlingS ? kJumpS : kMaxSlewS * elapsed_s;
    offset_s_ += std::clamp(shortest() - offset_s_, -max_step_s, max_step_s);
  }
  last_device_s_ = device_s;
  const double stamp_s = std::min(device_s + offset_s_, arrival_s);
  last_stamp_s_ = std::max(stamp_s, last_stamp_s_ + kMinIntervalS);
  return last_stamp_s_;
}

double RecordingClock::toReceiverTime(double device_s, double arrival_s) {
  const bool has_restarted = is_running_ && device_s < last_device_s_;
  const bool was_paused = follow_pauses_ && arrival_s - (device_s + offset_s_) > kPauseS;
  if (!is_running_ || has_restarted || was_paused) {
    const double begin_s = follow_pauses_ || !is_running_ ? arrival_s : last_stamp_s_;
    offset_s_ = std::max(begin_s, last_stamp_s_ + kFrameS) - device_s;
    is_running_ = true;
  }
  last_device_s_ = device_s;
  last_stamp_s_ = device_s + offset_s_;
  return last_stamp_s_;
}

}  // namespace depth_object_tracker
