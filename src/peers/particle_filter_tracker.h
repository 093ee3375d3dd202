// SPDX-License-Identifier: BSD-3-Clause
// PCL's KLD-adaptive particle filter tracker with the settings of its tutorial.
#pragma once

#include "peer_tracker.h"

namespace depth_object_tracker {

/// Settings of PCL's tutorial "Tracking object in real time", unless a comment says otherwise.
struct PclTrackerConfig {
  int num_particles = 600;
  int max_particles = 1000;
  double kld_delta = 0.99;
  double kld_epsilon = 0.2;
  double bin_size = 0.1;                ///< [m, rad]
  double step_stddev_m = 0.015;         ///< of a frame
  double rotation_variance_ratio = 40;  ///< variance of the angles [rad^2] over that of the position [m^2]
  double initial_variance = 1e-5;
  double max_distance_m = 0.01;  ///< of nearest neighbours
  float search_resolution_m = 0.01f;
  float grid_m = 0.002f;  ///< of the measured cloud
  /// The tutorial tracks a cloud seen before; here points of the whole mesh, so that the object may turn.
  std::size_t num_model_points = 800;
  double crop_margin_m = 0.1;  ///< around the bounding sphere at the last pose; the tutorial cuts at a fixed depth
};

std::unique_ptr<PeerTracker> makePclTracker(const TriangleMesh& mesh, unsigned num_threads,
                                            const PclTrackerConfig& config = {});

}  // namespace depth_object_tracker
