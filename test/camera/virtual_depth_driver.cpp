// SPDX-License-Identifier: BSD-3-Clause
// An OpenNI2 driver for tests: one depth camera, connected while the file named by VIRTUAL_DEPTH_PLUG exists. It can
// register depth to a colour camera where that file says "in, with colour".
#include "virtual_scene.h"

#include <Driver/OniDriverAPI.h>
#include <PS1080.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <mutex>
#include <new>
#include <thread>

// The macros that export a driver take these from a library of OpenNI's that is not installed.
#define XN_NEW(Type, ...) new Type(__VA_ARGS__)
#define XN_DELETE(pointer) delete (pointer)

namespace depth_object_tracker {
namespace {

std::array<OniVideoMode, 4> videoModes() {
  return {{{ONI_PIXEL_FORMAT_DEPTH_1_MM, 640, 480, 30},
           {ONI_PIXEL_FORMAT_DEPTH_1_MM, 320, 240, 30},
           {ONI_PIXEL_FORMAT_DEPTH_1_MM, 320, 240, 60},
           {ONI_PIXEL_FORMAT_DEPTH_100_UM, 320, 240, 30}}};
}

/// Copies a property's value out.
template <typename Value>
OniStatus give(const Value& value, void* data, int* size) {
  if (*size != static_cast<int>(sizeof(Value))) return ONI_STATUS_BAD_PARAMETER;
  std::memcpy(data, &value, sizeof(Value));
  return ONI_STATUS_OK;
}

template <typename Value>
OniStatus take(Value& value, const void* data, int size) {
  if (size != static_cast<int>(sizeof(Value))) return ONI_STATUS_BAD_PARAMETER;
  std::memcpy(&value, data, sizeof(Value));
  return ONI_STATUS_OK;
}

class VirtualStream : public oni::driver::StreamBase {
 public:
  ~VirtualStream() override { stop(); }

  OniStatus start() override {
    is_running_ = true;
    thread_ = std::thread([this] { run(); });
    return ONI_STATUS_OK;
  }

  void stop() override {
    is_running_ = false;
    if (thread_.joinable()) thread_.join();
  }

  OniBool isPropertySupported(int property) override {
    std::array<char, sizeof(OniCropping)> value{};
    int size = 0;  // no property has this size, so only the answers differ
    return getProperty(property, value.data(), &size) != ONI_STATUS_NOT_IMPLEMENTED;
  }

  OniStatus getProperty(int property, void* data, int* size) override {
    switch (property) {
      case ONI_STREAM_PROPERTY_VIDEO_MODE:
        return give(mode_, data, size);
      case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
        return give(static_cast<float>(kVirtualFovRad), data, size);
      case ONI_STREAM_PROPERTY_VERTICAL_FOV:
        return give(static_cast<float>(kVirtualVerticalFovRad), data, size);
      case ONI_STREAM_PROPERTY_MIRRORING:
        return give(OniBool{is_mirrored_}, data, size);
      // The player leaves out all images of a recording without these two.
      case ONI_STREAM_PROPERTY_STRIDE:
        return give(mode_.resolutionX * static_cast<int>(sizeof(std::uint16_t)), data, size);
      case ONI_STREAM_PROPERTY_CROPPING:
        return give(OniCropping{FALSE, 0, 0, 0, 0}, data, size);
      case ONI_STREAM_PROPERTY_MAX_VALUE:
        return give(10000, data, size);
      default:
        return ONI_STATUS_NOT_IMPLEMENTED;
    }
  }

  OniStatus setProperty(int property, const void* data, int size) override {
    OniBool is_mirrored = FALSE;
    switch (property) {
      case ONI_STREAM_PROPERTY_VIDEO_MODE:
        return take(mode_, data, size);
      case ONI_STREAM_PROPERTY_MIRRORING:
        if (take(is_mirrored, data, size) != ONI_STATUS_OK) return ONI_STATUS_BAD_PARAMETER;
        is_mirrored_ = is_mirrored != FALSE;
        return ONI_STATUS_OK;
      default:
        return ONI_STATUS_NOT_IMPLEMENTED;
    }
  }

 private:
  using Clock = std::chrono::steady_clock;

  void run() {
    const auto period = std::chrono::microseconds(1000000 / mode_.fps);
    for (auto due = Clock::now(); is_running_; due = std::max(due + period, Clock::now())) {
      std::this_thread::sleep_until(due);
      const auto since_start = std::chrono::duration_cast<std::chrono::microseconds>(due - begin_);
      raise(static_cast<std::uint64_t>(since_start.count()));
    }
  }

  void raise(std::uint64_t time_us) {
    OniFrame* frame = getServices().acquireFrame();
    if (frame == nullptr) return;
    const int width = mode_.resolutionX, height = mode_.resolutionY;
    auto* pixels = static_cast<std::uint16_t*>(frame->data);
    scene_.render(time_us, width, height, pixels);
    if (mode_.pixelFormat == ONI_PIXEL_FORMAT_DEPTH_100_UM) {
      for (int i = kStampPixels; i < width * height; ++i) pixels[i] = static_cast<std::uint16_t>(10 * pixels[i]);
    }
    if (is_mirrored_) {
      for (int row = 0; row < height; ++row) std::reverse(pixels + row * width, pixels + (row + 1) * width);
    }
    frame->frameIndex = ++index_;
    frame->videoMode = mode_;
    frame->width = width;
    frame->height = height;
    frame->cropOriginX = frame->cropOriginY = 0;
    frame->croppingEnabled = FALSE;
    frame->sensorType = ONI_SENSOR_DEPTH;
    frame->stride = width * static_cast<int>(sizeof(std::uint16_t));
    frame->dataSize = frame->stride * height;
    frame->timestamp = time_us;
    raiseNewFrame(frame);
    getServices().releaseFrame(frame);
  }

  VirtualScene scene_;
  OniVideoMode mode_ = videoModes()[0];
  std::atomic<bool> is_mirrored_{true};  // as devices are when nobody says otherwise
  std::atomic<bool> is_running_{false};
  int index_ = 0;
  // The clock runs on while streams come and go.
  inline static const Clock::time_point begin_ = Clock::now();
  std::thread thread_;
};

class VirtualDevice : public oni::driver::DeviceBase {
 public:
  OniStatus getSensorInfoList(OniSensorInfo** sensors, int* count) override {
    sensor_.sensorType = ONI_SENSOR_DEPTH;
    sensor_.numSupportedVideoModes = static_cast<int>(modes_.size());
    sensor_.pSupportedVideoModes = modes_.data();
    *sensors = &sensor_;
    *count = 1;
    return ONI_STATUS_OK;
  }

  oni::driver::StreamBase* createStream(OniSensorType type) override {
    return type == ONI_SENSOR_DEPTH ? new VirtualStream : nullptr;
  }

  void destroyStream(oni::driver::StreamBase* stream) override { delete stream; }

  OniBool isImageRegistrationModeSupported(OniImageRegistrationMode mode) override {
    return mode == ONI_IMAGE_REGISTRATION_OFF || hasColor();
  }

  OniStatus setProperty(int property, const void* data, int size) override {
    if (property != ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION || !hasColor()) return ONI_STATUS_NOT_IMPLEMENTED;
    return take(registration_, data, size);
  }

  OniStatus getProperty(int property, void* data, int* size) override {
    if (property == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION && hasColor()) return give(registration_, data, size);
    if (property != ONI_DEVICE_PROPERTY_SERIAL_NUMBER) return ONI_STATUS_NOT_IMPLEMENTED;
    if (*size <= static_cast<int>(std::strlen(kVirtualDeviceSerial))) return ONI_STATUS_BAD_PARAMETER;
    std::strcpy(static_cast<char*>(data), kVirtualDeviceSerial);
    return ONI_STATUS_OK;
  }

 private:
  static bool hasColor() {
    std::ifstream plug(std::getenv("VIRTUAL_DEPTH_PLUG"));
    std::string text;
    std::getline(plug, text);
    return text == kPlugWithColor;
  }

  std::array<OniVideoMode, 4> modes_ = videoModes();
  OniSensorInfo sensor_{};
  OniImageRegistrationMode registration_ = ONI_IMAGE_REGISTRATION_OFF;
};

class VirtualDriver : public oni::driver::DriverBase {
 public:
  explicit VirtualDriver(OniDriverServices* services) : DriverBase(services) {
    std::strncpy(info_.uri, kVirtualDeviceUri, sizeof(info_.uri) - 1);
    std::strncpy(info_.vendor, "Test", sizeof(info_.vendor) - 1);
    std::strncpy(info_.name, "virtual depth camera", sizeof(info_.name) - 1);
  }

  OniStatus initialize(oni::driver::DeviceConnectedCallback connected,
                       oni::driver::DeviceDisconnectedCallback disconnected,
                       oni::driver::DeviceStateChangedCallback state_changed, void* cookie) override {
    DriverBase::initialize(connected, disconnected, state_changed, cookie);
    watchPlug();
    is_running_ = true;
    watcher_ = std::thread([this] {
      for (; is_running_; std::this_thread::sleep_for(std::chrono::milliseconds(20))) watchPlug();
    });
    return ONI_STATUS_OK;
  }

  void shutdown() override {
    is_running_ = false;
    if (watcher_.joinable()) watcher_.join();
  }

  oni::driver::DeviceBase* deviceOpen(const char* uri, const char* /*mode*/) override {
    return std::strcmp(uri, kVirtualDeviceUri) == 0 && is_plugged_ ? new VirtualDevice : nullptr;
  }

  void deviceClose(oni::driver::DeviceBase* device) override { delete device; }

 private:
  void watchPlug() {
    const char* plug = std::getenv("VIRTUAL_DEPTH_PLUG");
    const bool is_plugged = plug != nullptr && std::ifstream(plug).good();
    if (is_plugged == is_plugged_) return;
    is_plugged_ = is_plugged;
    if (is_plugged) {
      deviceConnected(&info_);
    } else {
      deviceDisconnected(&info_);
    }
  }

  OniDeviceInfo info_{};
  std::atomic<bool> is_plugged_{false};
  std::atomic<bool> is_running_{false};
  std::thread watcher_;
};

}  // namespace
}  // namespace depth_object_tracker

using depth_object_tracker::VirtualDriver;
ONI_EXPORT_DRIVER(VirtualDriver)
