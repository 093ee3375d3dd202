// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/frame_clock.h"

namespace depth_object_tracker {

FrameClock::Step FrameClock::advance(double stamp_s) {
  const double dt = stamp_s - last_stamp_s_;
  if (started_ && dt == 0.0) return {Event::kDuplicate, 0.0};
  last_stamp_s_ = stamp_s;
  if (!started_) {
    started_ = true;
    return {Event::kFirst, 0.0};
  }
  return dt > 0.0 ? Step{Event::kForward, dt} : Step{Event::kBackward, 0.0};
}

}  // namespace depth_object_tracker
