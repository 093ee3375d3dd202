// SPDX-License-Identifier: BSD-3-Clause
// Climbs the likelihood of one frame from a start, without any prior: for poses that nothing is known of.
#pragma once

#include "depth_object_tracker/filter/pose_likelihood.h"

namespace depth_object_tracker {

struct ClimbSchedule {
  double first_width_m = 0.015;  ///< surface noise added in the first step; less from step to step
  double last_width_m = 0.004;   ///< below: no further steps
  int final_steps = 0;  ///< after that, with the model's own noise; the best pose of these and the start is kept
};

/// Gaussian belief about a pose, and how much of the likelihood counts beside it.
struct ClimbPrior {
  Pose mean = Pose::Identity();
  Vector6d variances = Vector6d::Ones();  ///< [m^2, rad^2]
  double likelihood_exponent = 1.0;       ///< in (0, 1]
};

/// Gauss-Newton steps with the model's own noise towards the posterior: directions that the image leaves free return to
/// the prior.
Pose climbPosterior(PoseLikelihood& likelihood, const Pose& T_camera_centre, const ClimbPrior& prior, int steps,
                    int thread);

/// Gauss-Newton steps of limited length. Thread-safe for different `thread`.
Pose climbLikelihood(PoseLikelihood& likelihood, const Pose& T_camera_centre, const ClimbSchedule& schedule,
                     int thread);

}  // namespace depth_object_tracker
