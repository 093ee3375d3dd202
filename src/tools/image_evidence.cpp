// SPDX-License-Identifier: BSD-3-Clause
#include "tools/image_evidence.h"

#include "depth_object_tracker/tracker/resolution.h"

namespace depth_object_tracker {

ImageEvidence::ImageEvidence(const TriangleMesh& mesh, const TrackerConfig& config)
    : centre_object_(surfaceCentroid(mesh)),
      filter_(config.filter),
      likelihood_(mesh, centre_object_, config.pixel, config.occlusion, 1, 1) {}

double ImageEvidence::between(const DepthImageView& depth, const PinholeCamera& camera, const Pose& T_camera_object,
                              const Pose& T_camera_object_other) {
  constexpr int kFactor = 2;
  likelihood_.resetOcclusion();
  likelihood_.setImage(depth, makeSamplingGrid(camera, kFactor), 0.0);
  const auto log_likelihood = [&](const Pose& pose) {
    return likelihood_.assess(pose * Eigen::Translation3d(centre_object_), 0).log_likelihood;
  };
  return likelihoodExponent(filter_, kFactor) *
         (log_likelihood(T_camera_object) - log_likelihood(T_camera_object_other));
}

}  // namespace depth_object_tracker
