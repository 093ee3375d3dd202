// SPDX-License-Identifier: BSD-3-Clause
// Other people's trackers, run for comparison.
#pragma once

#include "depth_object_tracker/geometry/depth_image.h"
#include "depth_object_tracker/geometry/pinhole_camera.h"
#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/geometry/triangle_mesh.h"
#include "depth_object_tracker/tools/track_sequence_options.h"

#include <functional>
#include <memory>

namespace depth_object_tracker {

struct PeerEstimate {
  Pose T_camera_object = Pose::Identity();
  double score = 0.0;  ///< [0, 1], 0 = the peer says itself that it has no pose
};

class PeerTracker {
 public:
  virtual ~PeerTracker() = default;
  virtual void initialise(const Pose& T_camera_object, const PinholeCamera& camera) = 0;
  virtual PeerEstimate update(const DepthImageView& depth, const PinholeCamera& camera) = 0;
};

using PeerFactory =
    std::function<std::unique_ptr<PeerTracker>(const TriangleMesh& mesh, const TrackSequenceOptions& options)>;

/// A program with track_sequence's arguments and estimates (no trace, no occlusion pictures).
/// @return exit code: 0 done, 1 input or run error, 2 usage.
int runPeer(int argc, const char* const* argv, const char* name, const PeerFactory& make_tracker);

}  // namespace depth_object_tracker
