// SPDX-License-Identifier: BSD-3-Clause
// The pose about a given one at which a value is highest, where that is none that the likelihood climbs to: beside a
// hand that explains more of the image, the object's own pose is a small peak. Draws that close in on the best of them.
#pragma once

#include "depth_object_tracker/filter/random.h"
#include "depth_object_tracker/filter/worker_pool.h"
#include "depth_object_tracker/geometry/pose.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace depth_object_tracker {

class PoseSampler {
 public:
  /// To be maximised; thread-safe for different `thread`. @param width_m surface noise added to the model's own, less
  /// from round to round and 0 in the last ones.
  using Value = std::function<double(const Pose& pose, double width_m, int thread)>;
  /// From a pose to the top of the peak that it is on; thread-safe for different `thread`.
  using Climb = std::function<Pose(const Pose& pose, int thread)>;

  PoseSampler(std::uint64_t seed, WorkerPool& pool) : random_(seed), pool_(pool) {}

  /// @param variances of the first draws about the middle [m^2, rad^2], see perturb(). @param first_draw number of the
  /// first random draw; numDraws() are used.
  Pose highest(const Pose& middle, const Vector6d& variances, const Value& value, const Climb& climb,
               std::uint64_t first_draw);
  static std::uint64_t numDraws();

 private:
  struct Sample {
    Pose pose;
    double value;
  };
  void valueAll(const Value& value, double width_m);
  void drawAbout(const Pose& middle, const Matrix6d& root, std::uint64_t first_draw);
  Matrix6d rootOfScatter(const Vector6d& least_variances) const;
  void climbAll(const Climb& climb);

  CounterRandom random_;
  WorkerPool& pool_;
  std::vector<Sample> samples_;
};

}  // namespace depth_object_tracker
