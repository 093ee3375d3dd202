// SPDX-License-Identifier: BSD-3-Clause
// Compares what the tracker says with the simulator's ground truth.
#pragma once

#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/geometry/symmetry.h"

#include <depth_object_tracker/TrackerStatus.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <ros/time.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace depth_object_tracker {

/// Pairs estimates with truth by stamp, in whatever order they come. Not thread-safe.
class SimulatorMonitor {
 public:
  explicit SimulatorMonitor(Symmetries symmetries) : symmetries_(std::move(symmetries)) {}

  void addTruth(const geometry_msgs::PoseStamped& pose);
  void addEstimate(const geometry_msgs::PoseWithCovarianceStamped& pose);
  void addStatus(const TrackerStatus& status) { status_ = status; }

  /// What happened since the last call, `period_s` seconds ago, in one line.
  std::string statusLine(double period_s);

  struct Summary {
    std::size_t images = 0;     ///< with ground truth
    std::size_t estimates = 0;  ///< of those, with an estimate
    std::size_t far_off = 0;    ///< of those, by more than kFarOffM
    double median_position_m = 0.0;
    double median_rotation_rad = 0.0;
    double worst_position_m = 0.0;
  };
  static constexpr double kFarOffM = 0.05;
  Summary summary() const;

 private:
  struct Error {
    double position_m;
    double rotation_rad;
  };
  using Stamped = std::map<ros::Time, Pose>;
  static constexpr std::size_t kKept = 90;  // seconds of poses that wait for their partner
  void pair(const ros::Time& stamp);
  Error errorOf(const Pose& T_camera_estimate, const Pose& T_camera_truth) const;

  Symmetries symmetries_;
  Stamped truths_, estimates_;
  std::optional<TrackerStatus> status_;
  std::vector<Error> errors_;
  std::size_t reported_ = 0;  // errors that a status line has told of
  std::size_t num_truths_ = 0;
};

}  // namespace depth_object_tracker
