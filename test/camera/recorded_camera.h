// SPDX-License-Identifier: BSD-3-Clause
// Tests with the virtual depth camera: a recording of it, its plug, and all that a DepthCamera says.
#pragma once

#include "slowness.h"
#include "virtual_scene.h"

#include "depth_object_tracker/camera/depth_camera.h"

#include <OpenNI.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <string>
#include <vector>

namespace depth_object_tracker {

inline void plugIn(const std::string& text = "in") {
  std::ofstream(std::getenv("VIRTUAL_DEPTH_PLUG")) << text;
}

inline void unplug() {
  std::remove(std::getenv("VIRTUAL_DEPTH_PLUG"));
}

/// Records images of the virtual camera with OpenNI's own recorder. Mirrored, as OpenNI's viewer does.
inline void recordVirtualCamera(const std::string& file, int num_frames, bool is_mirrored, int width = 320) {
  ASSERT_EQ(openni::OpenNI::initialize(), openni::STATUS_OK);
  {
    openni::Device device;
    ASSERT_EQ(device.open(kVirtualDeviceUri), openni::STATUS_OK) << openni::OpenNI::getExtendedError();
    openni::VideoStream stream;
    ASSERT_EQ(stream.create(device, openni::SENSOR_DEPTH), openni::STATUS_OK);
    openni::VideoMode mode;
    mode.setPixelFormat(openni::PIXEL_FORMAT_DEPTH_1_MM);
    mode.setResolution(width, width * 3 / 4);
    mode.setFps(30);
    ASSERT_EQ(stream.setVideoMode(mode), openni::STATUS_OK);
    stream.setMirroringEnabled(is_mirrored);
    openni::Recorder recorder;
    ASSERT_EQ(recorder.create(file.c_str()), openni::STATUS_OK) << openni::OpenNI::getExtendedError();
    ASSERT_EQ(recorder.attach(stream), openni::STATUS_OK);
    ASSERT_EQ(recorder.start(), openni::STATUS_OK);
    ASSERT_EQ(stream.start(), openni::STATUS_OK);
    openni::VideoFrameRef frame;
    for (int i = 0; i < num_frames; ++i) ASSERT_EQ(stream.readFrame(&frame), openni::STATUS_OK);
    frame.release();
    stream.stop();
    recorder.stop();
    recorder.destroy();
    stream.destroy();
    device.close();
  }
  openni::OpenNI::shutdown();
}

/// What came out of a camera.
class CameraLog {
 public:
  struct Image {
    DepthFrame frame;  // without data
    std::vector<std::uint8_t> millimetres;
    const std::uint16_t* pixels() const { return reinterpret_cast<const std::uint16_t*>(millimetres.data()); }
  };

  DepthCameraEvents events() {
    DepthCameraEvents events;
    events.on_frame = [this](const DepthFrame& frame) {
      Image image{frame, {}};
      copyMillimetres(frame, image.millimetres);
      image.frame.data = nullptr;
      const std::lock_guard<std::mutex> lock(mutex_);
      images_.push_back(std::move(image));
    };
    events.on_open = [this](const DeviceDescription&) { add("[open]"); };
    events.on_message = [this](DepthCameraEvents::Severity, const std::string& message) { add(message); };
    return events;
  }

  std::vector<Image> images() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return images_;
  }
  std::size_t size() const { return images().size(); }

  /// How many messages have this part.
  int count(const std::string& part) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    int count = 0;
    for (const std::string& message : messages_) count += message.find(part) != std::string::npos ? 1 : 0;
    return count;
  }

 private:
  void add(const std::string& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    messages_.push_back(message);
  }

  mutable std::mutex mutex_;
  std::vector<Image> images_;
  std::vector<std::string> messages_;
};

/// Waits long enough for the busiest machine.
template <typename Condition>
bool waitFor(const Condition& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(60.0 * kSlowness);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

}  // namespace depth_object_tracker
