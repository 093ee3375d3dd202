// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/tracker_diagnostics.h"

#include "depth_object_tracker/tracker/tracker_result.h"

#include <cstdio>

namespace depth_object_tracker {
namespace {

using Level = diagnostic_msgs::DiagnosticStatus;
using Wrapper = diagnostic_updater::DiagnosticStatusWrapper;

constexpr double kPeriodS = 1.0;
constexpr double kOutageS = 1.0;
constexpr double kOldStampS = 1.0, kFutureStampS = -0.2;
constexpr double kFewValidPixels = 0.05;
constexpr double kManyDrops = 0.2;

template <typename... Numbers>
std::string format(const char* text, Numbers... numbers) {
  char buffer[400];
  std::snprintf(buffer, sizeof(buffer), text, numbers...);
  return buffer;
}

unsigned char levelOf(const TrackerStatus& status) {
  if (status.paused || status.state == TrackerStatus::TRACKING) return Level::OK;
  return status.state == TrackerStatus::LOST ? Level::ERROR : Level::WARN;
}

}  // namespace

std::string findStampProblem(double stamp_age_s) {
  if (stamp_age_s > kOldStampS) {
    return format(
        "image stamps are %.1f s behind the clock: is a bag played without /use_sim_time and --clock, is the driver's "
        "queue long, or do two machines' clocks differ? tf and control_twist are looked up at these stamps",
        stamp_age_s);
  }
  if (stamp_age_s < kFutureStampS) {
    return format(
        "image stamps are %.1f s ahead of the clock: do two machines' clocks differ (chrony, ntp), or is a bag played "
        "with /use_sim_time but without --clock?",
        -stamp_age_s);
  }
  return "";
}

void describeInput(const DiagnosticSnapshot& snapshot, Wrapper& status) {
  const TrackerStatus& tracker = snapshot.status;
  const std::string stamp_problem = snapshot.stamp_age_s ? findStampProblem(*snapshot.stamp_age_s) : "";
  if (snapshot.seconds_without_image > kOutageS) {
    status.summary(Level::ERROR,
                   format("no image for %.0f s: is the camera running, and is depth/image remapped to it?",
                          snapshot.seconds_without_image));
  } else if (!stamp_problem.empty()) {
    status.summary(Level::WARN, stamp_problem);
  } else if (!tracker.paused && tracker.state != TrackerStatus::UNINITIALIZED &&
             tracker.valid_pixel_fraction < kFewValidPixels) {
    status.summary(Level::WARN,
                   format("only %.1f %% of the depth pixels are valid: is the unit right, or the lens covered?",
                          100.0 * static_cast<double>(tracker.valid_pixel_fraction)));
  } else {
    status.summary(Level::OK, format("%.1f images/s", static_cast<double>(tracker.input_rate_hz)));
  }
  status.add("input rate [Hz]", tracker.input_rate_hz);
  status.add("seconds without an image", snapshot.seconds_without_image);
  status.add("stamp age [s]", snapshot.stamp_age_s ? format("%.3f", *snapshot.stamp_age_s) : "unknown");
  status.add("valid pixel share", tracker.valid_pixel_fraction);
  status.add("frame", tracker.header.frame_id);
  status.add("images received", tracker.frames_received);
}

void describeTracking(const DiagnosticSnapshot& snapshot, Wrapper& status) {
  const TrackerStatus& tracker = snapshot.status;
  const std::string state = tracker.paused ? "PAUSED" : stateName(static_cast<TrackerState>(tracker.state));
  status.summary(levelOf(tracker), tracker.reason.empty() ? state : state + ": " + tracker.reason);
  status.add("state", state);
  status.add("object", tracker.object_name);
  status.add("visible share", tracker.visible_fraction);
  status.add("score", tracker.score);
  status.add("position stddev [m]", tracker.position_stddev_m);
  status.add("rotation stddev [rad]", tracker.rotation_stddev_rad);
  status.add("held by a robot", static_cast<bool>(tracker.grasped));
}

void describeLoad(const DiagnosticSnapshot& snapshot, Wrapper& status) {
  const TrackerStatus& tracker = snapshot.status;
  if (snapshot.dropped_share > kManyDrops) {
    status.summary(Level::WARN,
                   format("%.0f %% of the images are dropped: lower ~tracker/frame_budget_s, num_particles "
                          "or target_model_pixels, or raise num_threads",
                          100.0 * snapshot.dropped_share));
  } else {
    status.summary(Level::OK, format("%.1f ms a frame", 1e3 * static_cast<double>(tracker.frame_time_s)));
  }
  status.add("frame time [s]", tracker.frame_time_s);
  status.add("of it proposal [s]", format("%.4f", snapshot.stage_times.proposal_s));
  status.add("of it likelihood [s]", format("%.4f", snapshot.stage_times.render_likelihood_s));
  status.add("of it resampling [s]", format("%.4f", snapshot.stage_times.resample_s));
  status.add("latency [s]", tracker.latency_s);
  status.add("output rate [Hz]", tracker.output_rate_hz);
  status.add("particles", tracker.num_particles);
  status.add("effective sample size", tracker.effective_sample_size);
  status.add("images processed", tracker.frames_processed);
  status.add("images dropped", tracker.frames_dropped);
}

void describeSelfCheck(const DiagnosticSnapshot& snapshot, Wrapper& status) {
  if (snapshot.findings.empty()) {
    status.summary(Level::OK, "nothing suspicious");
  } else {
    status.summary(Level::WARN, snapshot.findings.front());
  }
  for (std::size_t i = 0; i < snapshot.findings.size(); ++i) {
    status.add("finding " + std::to_string(i + 1), snapshot.findings[i]);
  }
  if (!snapshot.frame_note.empty()) status.add("note", snapshot.frame_note);
}

TrackerDiagnostics::TrackerDiagnostics(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                                       const std::string& name, const std::string& hardware_id)
    : updater_(node, private_node, name) {
  updater_.setHardwareID(hardware_id);
  add("input", describeInput);
  add("tracking", describeTracking);
  add("load", describeLoad);
  add("self-check", describeSelfCheck);
  timer_ = private_node.createWallTimer(ros::WallDuration(kPeriodS),
                                        [this](const ros::WallTimerEvent&) { updater_.force_update(); });
}

void TrackerDiagnostics::setSnapshot(const DiagnosticSnapshot& snapshot) {
  const std::lock_guard<std::mutex> lock(mutex_);
  snapshot_ = snapshot;
}

void TrackerDiagnostics::add(const std::string& task, Describe describe) {
  updater_.add(task, [this, describe](Wrapper& status) {
    const std::lock_guard<std::mutex> lock(mutex_);
    describe(snapshot_, status);
  });
}

}  // namespace depth_object_tracker
