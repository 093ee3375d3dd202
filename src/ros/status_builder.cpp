// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/status_builder.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

float finiteFloat(double value) {
  return std::isfinite(value) ? static_cast<float>(value) : 0.0f;
}

float worstStddev(const Eigen::Matrix3d& covariance) {
  if (!covariance.allFinite()) return 0.0f;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  return finiteFloat(std::sqrt(std::max(0.0, solver.eigenvalues()(2))));
}

}  // namespace

TrackerStatus buildStatus(const TrackerResult& result, const StatusContext& context, const FrameStatistics& statistics,
                          const FrameInbox::Counters& counters) {
  TrackerStatus status;
  status.header = context.header;
  status.object_name = context.object_name;
  status.state = static_cast<std::uint8_t>(result.state);
  status.paused = context.paused;
  status.reason = result.reason;
  status.visible_fraction = finiteFloat(result.visible_fraction);
  status.score = finiteFloat(result.score);
  status.log_likelihood = std::isfinite(result.log_likelihood) ? result.log_likelihood : 0.0;
  status.effective_sample_size = finiteFloat(result.effective_sample_size);
  status.num_particles = static_cast<std::uint32_t>(std::max(0, result.num_particles));
  status.position_stddev_m = worstStddev(result.covariance.topLeftCorner<3, 3>());
  status.rotation_stddev_rad = worstStddev(result.covariance.bottomRightCorner<3, 3>());
  status.grasped = context.grasped;
  status.valid_pixel_fraction = finiteFloat(result.valid_pixel_fraction);
  status.input_rate_hz = finiteFloat(statistics.input_rate.hz());
  status.output_rate_hz = finiteFloat(statistics.output_rate.hz());
  status.frame_time_s = finiteFloat(result.time.total_s);
  status.latency_s = finiteFloat(statistics.latency_s);
  status.frames_received = counters.received;
  status.frames_processed = statistics.processed;
  status.frames_dropped = counters.dropped;
  return status;
}

}  // namespace depth_object_tracker
