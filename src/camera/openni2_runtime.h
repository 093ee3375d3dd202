// SPDX-License-Identifier: BSD-3-Clause
// OpenNI for as long as somebody needs it, and what it tells about devices that come and go.
#pragma once

#include <OpenNI.h>

#include <atomic>
#include <string>

namespace depth_object_tracker {

/// OpenNI's last error, as a part of a sentence.
std::string openniError();

/// Starts OpenNI; the last one stops it.
class OpenNI2Runtime {
 public:
  /// @throws CameraError
  OpenNI2Runtime();
  ~OpenNI2Runtime();
  OpenNI2Runtime(const OpenNI2Runtime&) = delete;
  OpenNI2Runtime& operator=(const OpenNI2Runtime&) = delete;
};

/// Notes what happens to one device. OpenNI calls from threads of its own.
class DeviceWatcher : public openni::OpenNI::DeviceDisconnectedListener,
                      public openni::OpenNI::DeviceStateChangedListener {
 public:
  explicit DeviceWatcher(std::string uri);
  ~DeviceWatcher() override;

  bool isConnected() const { return is_connected_; }
  bool isAtEnd() const { return is_at_end_; }

 private:
  void onDeviceDisconnected(const openni::DeviceInfo* info) override;
  void onDeviceStateChanged(const openni::DeviceInfo* info, openni::DeviceState state) override;

  const std::string uri_;
  std::atomic<bool> is_connected_{true};
  std::atomic<bool> is_at_end_{false};
};

}  // namespace depth_object_tracker
