// SPDX-License-Identifier: BSD-3-Clause
// One depth camera or .oni recording opened through OpenNI2.
#pragma once

#include "depth_object_tracker/camera/depth_camera_options.h"
#include "depth_object_tracker/camera/depth_frame.h"

#include <chrono>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace depth_object_tracker {

/// What could not be done, with which device, what OpenNI says, what to try: one sentence for the user.
class CameraError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct DeviceDescription {
  std::string uri;
  std::string name;    ///< as the vendor calls it
  std::string serial;  ///< empty: unknown
};

/// Not thread-safe, but OpenNI's own events may arrive meanwhile. Only one object at a time may hold a device.
class OpenNI2Device {
 public:
  /// Opens a device; its stream does not run yet.
  /// @param known_serial of a device that was unplugged: it is taken back although its URI has changed. May be empty.
  /// @throws CameraError when there is no such device (the message lists those that there are) or it gives no depth.
  OpenNI2Device(const DepthCameraOptions& options, const std::string& known_serial);
  ~OpenNI2Device();
  OpenNI2Device(const OpenNI2Device&) = delete;
  OpenNI2Device& operator=(const OpenNI2Device&) = delete;

  const DeviceDescription& description() const { return description_; }
  bool isRecording() const { return is_recording_; }

  /// In use; of a recording the one that it was made with.
  DepthMode mode() const { return mode_; }

  /// What was asked for but could not be had, one sentence each.
  const std::vector<std::string>& notes() const { return notes_; }

  /// @throws CameraError
  void start();
  void stop();

  /// Waits for the next image, at most `timeout`. The frame is valid until the next call. Images of a recording come
  /// one after the other, none left out.
  std::optional<DepthFrame> read(std::chrono::milliseconds timeout);

  /// False for good once the device was unplugged.
  bool isConnected() const;

  /// True when a recording has been played to its end.
  bool isAtEnd() const;

 private:
  struct Handles;  // keeps OpenNI's header out of this one

  void openDevice(const DepthCameraOptions& options, const std::string& known_serial);
  void openStream(const DepthCameraOptions& options);
  void setMode(const DepthCameraOptions& options);
  void setRegistration(bool is_wanted);
  void setUpRecording(const DepthCameraOptions& options);

  std::unique_ptr<Handles> handles_;
  DeviceDescription description_;
  DepthMode mode_;
  std::vector<std::string> notes_;
  bool is_recording_ = false;
  bool is_started_ = false;
  bool is_registered_ = false;
  double horizontal_fov_rad_ = 0.0;
};

/// Keeps OpenNI running, and so its list of devices up to date, until the last holder lets go.
/// @throws CameraError when OpenNI cannot be started.
std::shared_ptr<void> holdOpenNI2();

/// The devices that OpenNI sees now, recordings left out.
/// @throws CameraError when OpenNI cannot be started.
std::vector<DeviceDescription> listDevices();

}  // namespace depth_object_tracker
