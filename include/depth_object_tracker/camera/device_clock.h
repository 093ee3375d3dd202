// SPDX-License-Identifier: BSD-3-Clause
// Takes stamps of a device's own clock to the time of those who receive its images.
#pragma once

#include <array>
#include <limits>

namespace depth_object_tracker {

/// For live devices. An image arrives some time after its stamp; the shortest such delay of the last seconds tells how
/// far the clocks are apart, whatever load does to single images. The estimate follows drift between the clocks slowly,
/// so that intervals between stamps stay those of the device; stamps always increase. A jump of either clock starts
/// anew.
class DeviceClock {
 public:
  /// @param device_s [s] the device's stamp. @param arrival_s [s] when the image arrived, receiver's clock.
  /// @return [s] the stamp on the receiver's clock, never after `arrival_s` but to stay after the previous one.
  double toReceiverTime(double device_s, double arrival_s);

  void reset() { *this = DeviceClock(); }

 private:
  static constexpr double kWindowS = 5.0;          // the shortest delay is taken over one to two of these
  static constexpr double kSettlingS = 1.0;        // after a start stamps follow the shortest delay at once
  static constexpr double kJumpS = 0.5;            // clocks do not drift so far apart between two images
  static constexpr double kMaxSlewS = 0.005;       // per second: fifty times what quartz clocks drift
  static constexpr double kMinIntervalS = 0.0001;  // between stamps

  void restart(double device_s, double offset_s);
  double shortest() const;

  bool is_running_ = false;
  double offset_s_ = 0.0;  // receiver's clock minus device's clock
  double begin_s_ = 0.0;
  double window_begin_s_ = 0.0;
  std::array<double, 2> shortest_s_{};  // of this window and of the one before
  double last_device_s_ = 0.0;
  double last_stamp_s_ = -std::numeric_limits<double>::infinity();
};

/// For recordings: intervals stay exactly those of the recording, whatever speed it is played at. Recordings that start
/// again, and pauses, start anew at the time of arrival; stamps always increase.
class RecordingClock {
 public:
  /// @param follow_pauses false where stamps are not to keep up with the receiver's clock (other speeds than 1)
  explicit RecordingClock(bool follow_pauses) : follow_pauses_(follow_pauses) {}

  double toReceiverTime(double device_s, double arrival_s);

 private:
  static constexpr double kPauseS = 0.5;
  static constexpr double kFrameS = 1.0 / 30.0;  // between the last and the first image of a recording

  bool follow_pauses_;
  bool is_running_ = false;
  double offset_s_ = 0.0;
  double last_device_s_ = 0.0;
  double last_stamp_s_ = -std::numeric_limits<double>::infinity();
};

}  // namespace depth_object_tracker
