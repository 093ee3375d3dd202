// SPDX-License-Identifier: BSD-3-Clause
// Messages of one nodelet: each kind at most once in a few seconds of wall time, with the nodelet's name in front.
#pragma once

#include <ros/console.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <map>
#include <string>
#include <utility>

namespace depth_object_tracker {

/// In a manager all nodelets share one rosout name, so the message names the nodelet. Not thread-safe.
class ThrottledLog {
 public:
  static constexpr std::chrono::seconds kPeriod{5};

  explicit ThrottledLog(std::string nodelet) : nodelet_(std::move(nodelet)) {}

  /// Texts that differ in numbers alone are throttled together.
  void warn(const std::string& text) {
    if (isDue(withoutNumbers(text))) ROS_WARN_STREAM(nodelet_ << ": " << text);
  }
  void error(const std::string& text) {
    if (isDue(withoutNumbers(text))) ROS_ERROR_STREAM(nodelet_ << ": " << text);
  }
  void info(const std::string& text) const { ROS_INFO_STREAM(nodelet_ << ": " << text); }

 private:
  static constexpr std::size_t kMaxKinds = 256;  // names in messages come from outside

  static std::string withoutNumbers(std::string text) {
    text.erase(std::remove_if(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; }),
               text.end());
    return text;
  }

  bool isDue(const std::string& kind) {
    const auto now = std::chrono::steady_clock::now();
    if (last_.size() >= kMaxKinds) last_.clear();
    const auto [entry, is_new] = last_.try_emplace(kind, now);
    if (!is_new && now - entry->second < kPeriod) return false;
    entry->second = now;
    return true;
  }

  std::string nodelet_;
  std::map<std::string, std::chrono::steady_clock::time_point> last_;
};

}  // namespace depth_object_tracker
