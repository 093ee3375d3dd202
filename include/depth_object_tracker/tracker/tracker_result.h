// SPDX-License-Identifier: BSD-3-Clause
// What the tracker says about one image.
#pragma once

#include "depth_object_tracker/geometry/pinhole_camera.h"
#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/model/slip_estimator.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace depth_object_tracker {

/// Values as in TrackerStatus.msg.
enum class TrackerState : std::uint8_t {
  kUninitialized = 0,
  kInitializing = 1,
  kTracking = 2,
  kOccluded = 3,
  kLost = 4
};

/// "UNINITIALIZED", "INITIALIZING", "TRACKING", "OCCLUDED", "LOST".
const char* stateName(TrackerState state);

struct StageTimes {
  double total_s = 0.0;  ///< decoded depth in memory to estimate ready
  double proposal_s = 0.0;
  double render_likelihood_s = 0.0;  ///< complete likelihoods of particles, occlusion update included
  double resample_s = 0.0;
};

struct TrackerResult {
  enum class Input { kUsed, kDuplicateStamp, kTimeJumpedBack, kNoValidDepth, kUnusable };

  double stamp_s = 0.0;
  TrackerState state = TrackerState::kUninitialized;
  std::string reason;                       ///< what is wrong and what to do; empty when TRACKING
  Input input = Input::kUsed;               ///< what became of the image
  bool has_pose = false;                    ///< an estimate exists (also while OCCLUDED; the last one while LOST)
  Pose T_camera_object = Pose::Identity();  ///< of the mesh origin
  Matrix6d covariance = Matrix6d::Zero();   ///< of the mesh origin [m, rad], optical-frame axes
  Vector6d twist = Vector6d::Zero();        ///< of the mesh origin [m/s, rad/s], optical-frame axes
  Matrix6d twist_covariance = Matrix6d::Zero();
  bool grasped = false;
  std::optional<SlipEstimate> slip;  ///< motion of the mesh origin in the hand; only while the hand is followed
  double effective_sample_size = 0.0;
  int num_particles = 0;
  double visible_fraction = 0.0;      ///< share of the object's pixels believed visible, [0, 1]
  double score = 0.0;                 ///< 1 = visible pixels fit as the sensor model expects, 0 = not at all
  double log_likelihood = 0.0;        ///< [nat] against "no object", untempered, weighted mean over particles
  double valid_pixel_fraction = 0.0;  ///< share of the working image with a depth reading
  int downsampling = 0;               ///< sampling factor in use
  int pixels = 0;                     ///< pixels that the estimate covers at working resolution
  int pose_evaluations = 0;           ///< complete likelihoods of distinct poses
  StageTimes time;
};

struct ParticlePoses {
  std::vector<Pose> T_camera_object;  ///< mesh origins
  std::vector<float> weights;         ///< sum 1
};

struct OcclusionMap {
  SamplingGrid grid;              ///< working resolution
  std::vector<float> p_occluded;  ///< row-major, NaN where the particles covering the pixel weigh under 0.5
};

}  // namespace depth_object_tracker
