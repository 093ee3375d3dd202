// SPDX-License-Identifier: BSD-3-Clause
// A depth camera that may come and go: a thread opens it, hands its images out, and waits for it when it is unplugged.
#pragma once

#include "depth_object_tracker/camera/openni2_device.h"

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace depth_object_tracker {

/// What the camera's thread calls. May throw nothing. Calls never overlap.
struct DepthCameraEvents {
  enum class Severity { kInfo, kWarning, kError };

  std::function<void(const DepthFrame&)> on_frame;
  /// The device was opened: stamps and calibration are those of another device from now on.
  std::function<void(const DeviceDescription&)> on_open;
  std::function<void(Severity, const std::string&)> on_message;  ///< each state once, not over and over
};

/// The stream runs only while images are wanted; a recording waits where it is. All functions are thread-safe.
class DepthCamera {
 public:
  DepthCamera(const DepthCameraOptions& options, DepthCameraEvents events);

  /// Waits for the call in work. Not to be called by an event.
  ~DepthCamera();

  /// Whether anybody wants images. False at first.
  void setWanted(bool is_wanted);

  /// Opens the device anew with these options.
  void setOptions(const DepthCameraOptions& options);

 private:
  using Clock = std::chrono::steady_clock;

  void run();
  void work();
  void adoptOptions();
  bool open();
  void stream();
  void handOut(const DepthFrame& frame);
  void close(const std::string& reason);
  void handleSilence();
  void pace(const DepthFrame& frame);
  bool sleepUntil(Clock::time_point time);
  void report(DepthCameraEvents::Severity severity, const std::string& message);

  DepthCameraEvents events_;

  std::mutex mutex_;  // guards what others set
  std::condition_variable changed_;
  DepthCameraOptions wished_;
  bool has_new_options_ = false;
  bool is_wanted_ = false;
  bool is_stopping_ = false;

  // The thread's own.
  DepthCameraOptions options_;
  std::shared_ptr<void> openni2_;  // starting it anew for every attempt to open a device would load all drivers again
  std::unique_ptr<OpenNI2Device> device_;
  std::string serial_;        // of the device that was open last
  std::string last_message_;  // each is reported once
  Clock::time_point last_frame_at_;
  bool has_ended_ = false;
  Clock::time_point due_;  // of the next image of a recording
  double last_timestamp_s_ = -1.0;
  std::thread thread_;
};

}  // namespace depth_object_tracker
