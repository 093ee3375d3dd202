// SPDX-License-Identifier: BSD-3-Clause
// How far the parts of an image disagree about a pose, and the covariance that follows.
#pragma once

#include "depth_object_tracker/filter/pose_likelihood.h"

namespace depth_object_tracker {

/// Sums over the blocks of an image (8x8 cells). At the maximum of the likelihood the blocks' gradients add up to zero;
/// how large they are by themselves shows what noise there really is, with all that neighbouring pixels share: the
/// sensor's smoothing, steps of its disparity, dents that the mesh does not have.
struct ScoreScatter {
  Matrix6d information = Matrix6d::Zero();  ///< as of Linearisation; what independent pixels would mean
  Matrix6d scatter = Matrix6d::Zero();      ///< sum of gradient gradient^T
  int blocks = 0;                           ///< that say anything

  void add(const Linearisation& block);
};

/// States covariances as the data themselves bear them out ("sandwich": A^-1 B A^-1 of a misspecified likelihood, with
/// clusters). The filter tempers the likelihood by one exponent for all scenes, which keeps it alive; errors depend on
/// sensor, mesh, distance and what is in sight.
class CovarianceCalibration {
 public:
  void restart() { ratio_ = 0.0; }

  /// @param covariance of a filter that raised the likelihood to `exponent`. @param prior_variances of one step of the
  /// process: what the image says nothing of stays as it is. @param radius_m of the object. @param dt_s since the last
  /// image. @return covariance; unchanged when too little is seen.
  Matrix6d calibrated(const Matrix6d& covariance, const ScoreScatter& scores, double exponent,
                      const Vector6d& prior_variances, double radius_m, double dt_s);

 private:
  void follow(const ScoreScatter& scores, double dt_s);

  double ratio_ =
      0.0;  // noise that there is to what independent pixels would have, mean over the last images; 0 = none
};

}  // namespace depth_object_tracker
