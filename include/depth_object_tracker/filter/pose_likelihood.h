// SPDX-License-Identifier: BSD-3-Clause
// What the particle filter needs to know of a measurement. The depth image is one implementation, closed-form toys in
// tests others.
#pragma once

#include "depth_object_tracker/geometry/pose.h"

#include <functional>
#include <vector>

namespace depth_object_tracker {

/// Second-order model of a log-likelihood about a pose: log L(perturb(pose, d)) ~ log L + gradient.d - d.information.d
/// / 2.
struct Linearisation {
  Vector6d gradient = Vector6d::Zero();
  Matrix6d information = Matrix6d::Zero();  ///< positive semi-definite; zero where nothing is seen
};

/// Log-likelihood of one frame as a function of the pose of the object's centre; untempered [nat], against "no object".
class PoseLikelihood {
 public:
  virtual ~PoseLikelihood() = default;

  /// Called once a frame, before all else, with poses that bound the region of interest. Not thread-safe.
  virtual void prepare(const std::vector<Pose>& T_camera_centre) = 0;

  /// With the particles' mean belief about occlusion; changes nothing. Thread-safe for different `thread`.
  virtual double logLikelihood(const Pose& T_camera_centre, int thread) = 0;

  /// The same with surface noise widened by `extra_stddev_m`, so that poses near the right one stand out too.
  virtual double broadLogLikelihood(const Pose& T_camera_centre, double /*extra_stddev_m*/, int thread) {
    return logLikelihood(T_camera_centre, thread);
  }

  /// @param extra_stddev_m widens the surface noise so that a far start still pulls towards the data; 0 = the model.
  /// Thread-safe for different `thread`.
  virtual Linearisation linearise(const Pose& T_camera_centre, double extra_stddev_m, int thread) = 0;

  /// Log-likelihood of every particle with its own memory, which moves on to its posterior.
  virtual void update(const std::vector<Pose>& T_camera_centre, std::vector<double>& log_likelihoods) = 0;

  /// The particle in slot i continues from that in slot source[i]; slots with source[i] == i keep theirs.
  virtual void resample(const std::vector<int>& source) = 0;

  /// False when what is seen there is not what the model expects of the object.
  virtual bool explains(const Pose& /*T_camera_centre*/) { return true; }

  virtual int numThreads() const { return 1; }

  /// Calls task(index, thread) for every index in [0, count), each once, on numThreads() threads.
  virtual void parallelFor(int count, const std::function<void(int index, int thread)>& task) {
    for (int index = 0; index < count; ++index) task(index, 0);
  }
};

}  // namespace depth_object_tracker
