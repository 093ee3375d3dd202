// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/frame_inbox.h"

#include <utility>

namespace depth_object_tracker {

void FrameInbox::postFrame(CameraFrame frame) {
  std::optional<CameraFrame> replaced;  // released after the lock: it may own the last reference to an image
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (stopped_) return;
    ++counters_.received;
    if (frame_) ++counters_.dropped;
    replaced = std::exchange(frame_, std::move(frame));
  }
  changed_.notify_one();
}

bool FrameInbox::postCommand(Command command) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (stopped_ || commands_.size() >= kMaxCommands) return false;
    commands_.push_back(std::move(command));
  }
  changed_.notify_one();
  return true;
}

std::optional<FrameInbox::Delivery> FrameInbox::wait(std::chrono::duration<double> timeout) {
  return waitUntil(timeout, true);
}

std::optional<FrameInbox::Delivery> FrameInbox::waitForCommands(std::chrono::duration<double> timeout) {
  return waitUntil(timeout, false);
}

void FrameInbox::stop() {
  std::deque<Command> discarded_commands;
  std::optional<CameraFrame> discarded_frame;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopped_ = true;
    discarded_commands.swap(commands_);
    discarded_frame.swap(frame_);
  }
  changed_.notify_all();
}

FrameInbox::Counters FrameInbox::counters() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return counters_;
}

std::optional<FrameInbox::Delivery> FrameInbox::waitUntil(std::chrono::duration<double> timeout, bool take_frame) {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait_for(lock, timeout, [&] { return stopped_ || !commands_.empty() || (take_frame && frame_); });
  if (stopped_) return std::nullopt;
  Delivery delivery;
  delivery.commands.swap(commands_);
  if (take_frame) delivery.frame.swap(frame_);
  return delivery;
}

}  // namespace depth_object_tracker
