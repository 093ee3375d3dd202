// SPDX-License-Identifier: BSD-3-Clause
// What the robot reported about its joints lately, and where they were at any time in between.
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace depth_object_tracker {

/// One message of joint states or commands: any joints, in any order.
struct JointReport {
  double stamp_s = 0.0;
  std::vector<std::string> names;
  std::vector<double> positions;   ///< [rad or m]; empty = none, otherwise one per name
  std::vector<double> velocities;  ///< [rad/s or m/s]; empty = none, otherwise one per name
};

/// A series of its own for each joint, so that several publishers may each know a part of the robot. Not thread-safe.
class JointStateBuffer {
 public:
  static constexpr std::size_t kCapacity = 4096;  ///< samples per joint
  static constexpr std::size_t kMaxJoints = 512;  ///< names come from outside
  static constexpr double kHistoryS = 2.5;  ///< older samples than this, seen from the joint's newest, are forgotten

  /// @param max_age_s a sample says nothing about times further away than this.
  /// @param continuous joints whose positions jump by whole turns.
  explicit JointStateBuffer(double max_age_s = 0.1, std::set<std::string> continuous = {});

  /// Reports may come late. A stamp from before a joint's history means that time jumped back: its series starts anew.
  /// What is not finite is left out.
  /// @return empty, or what was wrong with the report (the rest of it is used).
  std::string add(const JointReport& report);

  /// Position at a time: between two samples by their velocities where both have one, else linearly; after the newest
  /// by its velocity, for up to max_age_s.
  /// @return nullopt when there is no sample near enough.
  std::optional<double> position(const std::string& joint, double stamp_s) const;

  /// Integral of the velocity over (from_s, to_s], trapezoidal between samples; before the first and after the last
  /// sample the velocity is held for up to max_age_s.
  /// @return nullopt when samples with velocity do not cover all of it.
  std::optional<double> travel(const std::string& joint, double from_s, double to_s) const;

  /// The same for commands: each holds from its stamp until the next one comes, or for max_age_s.
  std::optional<double> commandedTravel(const std::string& joint, double from_s, double to_s) const;

  /// Stamp of the joint's newest sample; nullopt = never reported.
  std::optional<double> newestStamp(const std::string& joint) const;

  /// All joints that were ever reported.
  std::vector<std::string> names() const;

  void clear() { series_.clear(); }
  double maxAge() const { return max_age_s_; }

 private:
  struct Sample {
    double stamp_s;
    double position;  // NaN = not reported
    double velocity;  // NaN = not reported
  };
  using Series = std::deque<Sample>;

  void insert(const std::string& joint, Sample sample);
  const Series* find(const std::string& joint) const;

  double max_age_s_;
  std::set<std::string> continuous_;
  std::map<std::string, Series> series_;
};

}  // namespace depth_object_tracker
