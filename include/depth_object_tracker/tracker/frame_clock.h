// SPDX-License-Identifier: BSD-3-Clause
// Makes time steps out of image stamps: duplicates, jumps back and gaps included.
#pragma once

namespace depth_object_tracker {

class FrameClock {
 public:
  enum class Event { kFirst, kForward, kDuplicate, kBackward };

  struct Step {
    Event event;
    double dt_s;  ///< > 0 for kForward, else 0
  };

  /// @param stamp_s finite. The first stamp after reset() is kFirst. A duplicate leaves the clock as it is.
  Step advance(double stamp_s);

  void reset() { started_ = false; }

 private:
  bool started_ = false;
  double last_stamp_s_ = 0.0;
};

}  // namespace depth_object_tracker
