// SPDX-License-Identifier: BSD-3-Clause
// Frame after frame for a DepthLikelihood, as a particle filter would have it.
#pragma once

#include "benchmark_scene.h"

#include "depth_object_tracker/filter/depth_likelihood.h"

#include <vector>

namespace depth_object_tracker {

/// Everything is drawn beforehand, so that frames differ but nothing is allocated between them.
class FilterFrames {
 public:
  /// Afterwards images, poses and ancestry have met in most combinations.
  static constexpr int kWarmUp = 20;

  FilterFrames(const BenchmarkScene& scene, int num_particles) : scene_(scene) {
    for (std::uint64_t seed = 0; seed < 4; ++seed) poses_.push_back(scene.drawPoses(num_particles, seed));
    for (std::uint64_t seed = 0; seed < 5; ++seed) ancestry_.push_back(drawAncestry(num_particles, seed));
  }

  /// Next image, next ancestors; returns the next poses.
  const std::vector<Pose>& next(DepthLikelihood& likelihood) {
    ++index_;
    likelihood.setImage(scene_.frame(index_), scene_.grid(), BenchmarkScene::kFrameTimeS);
    likelihood.resample(ancestry_[static_cast<std::size_t>(index_) % ancestry_.size()]);
    return poses_[static_cast<std::size_t>(index_) % poses_.size()];
  }

 private:
  const BenchmarkScene& scene_;
  std::vector<std::vector<Pose>> poses_;
  std::vector<std::vector<int>> ancestry_;
  int index_ = 0;
};

}  // namespace depth_object_tracker
