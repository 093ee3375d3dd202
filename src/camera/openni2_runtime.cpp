// SPDX-License-Identifier: BSD-3-Clause
#include "openni2_runtime.h"

#include "depth_object_tracker/camera/openni2_device.h"

#include <utility>

namespace depth_object_tracker {

std::string openniError() {
  std::string text = openni::OpenNI::getExtendedError();
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ' || text.back() == '\t')) text.pop_back();
  for (char& c : text) {
    if (c == '\n' || c == '\t') c = ' ';
  }
  return text.empty() ? "OpenNI gives no reason" : "OpenNI says: " + text;
}

OpenNI2Runtime::OpenNI2Runtime() {
  if (openni::OpenNI::initialize() == openni::STATUS_OK) return;
  const std::string reason = openniError();
  openni::OpenNI::shutdown();  // it counts starts that failed as well
  throw CameraError("OpenNI2 cannot be started; are its drivers installed (package libopenni2-0)? " + reason);
}

OpenNI2Runtime::~OpenNI2Runtime() {
  openni::OpenNI::shutdown();
}

DeviceWatcher::DeviceWatcher(std::string uri) : uri_(std::move(uri)) {
  openni::OpenNI::addDeviceDisconnectedListener(this);
  openni::OpenNI::addDeviceStateChangedListener(this);
}

DeviceWatcher::~DeviceWatcher() {
  openni::OpenNI::removeDeviceDisconnectedListener(this);
  openni::OpenNI::removeDeviceStateChangedListener(this);
}

void DeviceWatcher::onDeviceDisconnected(const openni::DeviceInfo* info) {
  if (uri_ == info->getUri()) is_connected_ = false;
}

void DeviceWatcher::onDeviceStateChanged(const openni::DeviceInfo* info, openni::DeviceState state) {
  if (uri_ != info->getUri()) return;
  if (state == openni::DEVICE_STATE_EOF) is_at_end_ = true;
  if (state == openni::DEVICE_STATE_ERROR) is_connected_ = false;
}

}  // namespace depth_object_tracker
