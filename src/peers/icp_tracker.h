// SPDX-License-Identifier: BSD-3-Clause
// Frame-to-model point-to-plane ICP of PCL at full resolution.
#pragma once

#include "peer_tracker.h"

#include <vector>

namespace depth_object_tracker {

/// PCL's IterativeClosestPointWithNormals with its symmetric objective. Settings found by trying on simulated scenes.
struct IcpConfig {
  std::size_t num_model_points = 800;
  /// Largest distance of corresponding points, from stage to stage [m]; the visible surface is chosen anew for each.
  std::vector<double> max_distances_m{0.06, 0.03, 0.015, 0.006};
  int iterations_per_stage = 10;
  double min_normal_cosine = 0.77;       ///< of the angle between corresponding normals
  double crop_margin_m = 0.05;           ///< of the measured cloud, around the object's bounding sphere
  double max_depth_step = 0.02;          ///< relative; no normal across larger steps
  float normal_smoothing_px = 8.0f;      ///< window of the measured normals
  std::size_t min_correspondences = 20;  ///< with fewer the last pose is kept
};

std::unique_ptr<PeerTracker> makeIcpTracker(const TriangleMesh& mesh, const IcpConfig& config = {});

}  // namespace depth_object_tracker
