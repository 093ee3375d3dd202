// SPDX-License-Identifier: BSD-3-Clause
// /diagnostics: input, tracking, load and self-check of one tracker, once a second.
#pragma once

#include "depth_object_tracker/tracker/tracker_result.h"

#include <depth_object_tracker/TrackerStatus.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace depth_object_tracker {

/// What the diagnostics are made of.
struct DiagnosticSnapshot {
  TrackerStatus status;
  StageTimes stage_times;  ///< of the last processed image
  double seconds_without_image = 0.0;
  std::optional<double> stamp_age_s;  ///< of the last image when it was taken up; nullopt: no image or no clock yet
  double dropped_share = 0.0;         ///< of the images of the last seconds
  std::vector<std::string> findings;  ///< of the self-check
  std::string frame_note;             ///< what tf lacks; "" = nothing
};

/// Why the age of the image stamps is odd, and what to do; "" when it is not.
std::string findStampProblem(double stamp_age_s);

void describeInput(const DiagnosticSnapshot& snapshot, diagnostic_updater::DiagnosticStatusWrapper& status);
void describeTracking(const DiagnosticSnapshot& snapshot, diagnostic_updater::DiagnosticStatusWrapper& status);
void describeLoad(const DiagnosticSnapshot& snapshot, diagnostic_updater::DiagnosticStatusWrapper& status);
void describeSelfCheck(const DiagnosticSnapshot& snapshot, diagnostic_updater::DiagnosticStatusWrapper& status);

/// Publishes by wall clock: simulated time may stand still.
class TrackerDiagnostics {
 public:
  /// @param name of the nodelet, from the root. @param hardware_id what the images come from.
  TrackerDiagnostics(const ros::NodeHandle& node, const ros::NodeHandle& private_node, const std::string& name,
                     const std::string& hardware_id);

  /// From any thread.
  void setSnapshot(const DiagnosticSnapshot& snapshot);

 private:
  using Describe = void (*)(const DiagnosticSnapshot&, diagnostic_updater::DiagnosticStatusWrapper&);
  void add(const std::string& task, Describe describe);

  std::mutex mutex_;  // guards snapshot_
  DiagnosticSnapshot snapshot_;
  diagnostic_updater::Updater updater_;
  ros::WallTimer timer_;
};

}  // namespace depth_object_tracker
