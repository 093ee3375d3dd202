// SPDX-License-Identifier: BSD-3-Clause
// The one hand-over between the ROS callbacks and the tracker's thread: the newest image wins, commands queue up.
#pragma once

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>

namespace depth_object_tracker {

/// An image, never copied, with the camera_info that belongs to it.
struct CameraFrame {
  sensor_msgs::ImageConstPtr image;
  sensor_msgs::CameraInfoConstPtr info;               ///< null: none came
  std::chrono::steady_clock::time_point received_at;  ///< wall clock of the image callback
};

/// Any thread posts; one thread waits. All functions are thread-safe.
class FrameInbox {
 public:
  using Command = std::function<void()>;
  static constexpr std::size_t kMaxCommands = 4096;

  struct Delivery {
    std::deque<Command> commands;  ///< in the order of posting; to be carried out before the frame
    std::optional<CameraFrame> frame;
  };

  /// Keeps the frame in place of one that was not taken yet, which then counts as dropped.
  void postFrame(CameraFrame frame);

  /// @return false when the worker is stopped or hopelessly behind; the command is then not kept.
  bool postCommand(Command command);

  /// Waits until something is there, at most `timeout`. nullopt after stop().
  std::optional<Delivery> wait(std::chrono::duration<double> timeout);

  /// The same for commands alone: a frame stays where it is.
  std::optional<Delivery> waitForCommands(std::chrono::duration<double> timeout);

  /// Wakes the waiting thread for good; what has not been taken is discarded.
  void stop();

  struct Counters {
    std::uint64_t received = 0;
    std::uint64_t dropped = 0;
  };
  Counters counters() const;

 private:
  std::optional<Delivery> waitUntil(std::chrono::duration<double> timeout, bool take_frame);

  mutable std::mutex mutex_;  // guards everything below
  std::condition_variable changed_;
  std::deque<Command> commands_;
  std::optional<CameraFrame> frame_;
  Counters counters_;
  bool stopped_ = false;
};

}  // namespace depth_object_tracker
