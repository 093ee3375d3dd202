// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/camera/depth_camera.h"

#include <exception>
#include <utility>

namespace depth_object_tracker {
namespace {

using Severity = DepthCameraEvents::Severity;
using Seconds = std::chrono::duration<double>;
constexpr std::chrono::milliseconds kReadTimeout{100};  // also how long a wish may wait to be noticed
constexpr std::chrono::milliseconds kRetryPeriod{500};  // between attempts to open a device that is not there
constexpr std::chrono::seconds kLongestSilence{5};      // a device that is quiet for longer is opened anew
constexpr Seconds kLongestLag{0.5};                     // a recording that is later than that was paused

}  // namespace

DepthCamera::DepthCamera(const DepthCameraOptions& options, DepthCameraEvents events)
    : events_(std::move(events)), options_(options), thread_([this] { run(); }) {}

DepthCamera::~DepthCamera() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void DepthCamera::setWanted(bool is_wanted) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_wanted_ = is_wanted;
  }
  changed_.notify_all();
}

void DepthCamera::setOptions(const DepthCameraOptions& options) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    wished_ = options;
    has_new_options_ = true;
  }
  changed_.notify_all();
}

void DepthCamera::run() {
  for (;;) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (is_stopping_) break;
    }
    try {
      work();
    } catch (const std::exception& error) {  // a crash would take the tracker in the same process with it
      report(Severity::kError, error.what());
      device_.reset();
      sleepUntil(Clock::now() + kRetryPeriod);
    }
  }
  device_.reset();
  openni2_.reset();
}

void DepthCamera::work() {
  adoptOptions();
  if (!device_ && !open()) {
    sleepUntil(Clock::now() + kRetryPeriod);
  } else if (!device_->isConnected()) {
    close("was unplugged");
  } else {
    stream();
  }
}

void DepthCamera::adoptOptions() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!has_new_options_) return;
  has_new_options_ = false;
  options_ = wished_;
  device_.reset();
}

bool DepthCamera::open() {
  try {
    if (!openni2_) openni2_ = holdOpenNI2();
    device_ = std::make_unique<OpenNI2Device>(options_, serial_);
  } catch (const CameraError& error) {
    report(Severity::kError, std::string(error.what()) + " (waiting for it)");
    return false;
  }
  const DeviceDescription& description = device_->description();
  if (!description.serial.empty()) serial_ = description.serial;
  for (const std::string& note : device_->notes()) report(Severity::kWarning, note);
  report(Severity::kInfo, "opened '" + description.uri + "' (" + description.name +
                              (description.serial.empty() ? "" : ", serial number " + description.serial) + "), " +
                              toString(device_->mode()));
  last_frame_at_ = Clock::now();
  last_timestamp_s_ = -1.0;
  has_ended_ = false;
  events_.on_open(description);
  return true;
}

void DepthCamera::stream() {
  {
    std::unique_lock<std::mutex> lock(mutex_);
    if (!is_wanted_ || has_ended_) {  // at the end of a recording OpenNI's own thread would spin
      lock.unlock();
      device_->stop();
      lock.lock();
      changed_.wait_for(lock, kReadTimeout,
                        [&] { return (is_wanted_ && !has_ended_) || is_stopping_ || has_new_options_; });
      last_frame_at_ = Clock::now();
      return;
    }
  }
  device_->start();
  if (const auto frame = device_->read(kReadTimeout)) {
    handOut(*frame);
  } else {
    handleSilence();
  }
}

void DepthCamera::handOut(const DepthFrame& frame) {
  if (device_->isRecording()) pace(frame);
  last_frame_at_ = Clock::now();
  events_.on_frame(frame);
}

void DepthCamera::handleSilence() {
  if (device_->isRecording()) {
    if (!device_->isAtEnd()) return;
    report(Severity::kInfo, "'" + options_.device + "' has ended");
    has_ended_ = true;
  } else if (Clock::now() - last_frame_at_ > kLongestSilence) {
    close("has sent no image for " + std::to_string(kLongestSilence.count()) + " s");
  }
}

void DepthCamera::close(const std::string& reason) {
  report(Severity::kWarning, "'" + device_->description().uri + "' " + reason + "; waiting for it");
  device_.reset();
}

/// Sleeps until the image of a recording is due. Images of OpenNI's own player fall ever further behind.
void DepthCamera::pace(const DepthFrame& frame) {
  const double interval_s = frame.timestamp_s - last_timestamp_s_;
  const bool is_first = last_timestamp_s_ < 0.0 || interval_s < 0.0;
  last_timestamp_s_ = frame.timestamp_s;
  if (options_.playback_speed <= 0.0) return;
  if (!is_first) due_ += std::chrono::duration_cast<Clock::duration>(Seconds(interval_s / options_.playback_speed));
  if (is_first || Clock::now() - due_ > kLongestLag) due_ = Clock::now();
  sleepUntil(due_);
}

/// @return false when there is something else to do before.
bool DepthCamera::sleepUntil(Clock::time_point time) {
  std::unique_lock<std::mutex> lock(mutex_);
  return !changed_.wait_until(lock, time, [&] { return is_stopping_ || has_new_options_; });
}

void DepthCamera::report(Severity severity, const std::string& message) {
  if (message == last_message_) return;
  last_message_ = message;
  events_.on_message(severity, message);
}

}  // namespace depth_object_tracker
