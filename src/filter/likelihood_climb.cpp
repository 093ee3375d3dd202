// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/filter/likelihood_climb.h"

#include <Eigen/Cholesky>

#include <algorithm>

namespace depth_object_tracker {
namespace {

// No step is longer than about this: the local model holds no further.
constexpr double kStepStddevM = 0.02;
constexpr double kStepStddevRad = 0.25;
constexpr double kMaxStepM = 0.03;
constexpr double kMaxStepRad = 0.35;
constexpr double kRatio = 0.8;  // of a step's width to the one before

void takeStep(PoseLikelihood& likelihood, double width_m, int thread, Pose& pose, const ClimbPrior* prior = nullptr) {
  Linearisation model = likelihood.linearise(pose, width_m, thread);
  if (prior != nullptr) {
    const Vector6d prior_information = prior->variances.cwiseInverse();
    model.gradient =
        prior->likelihood_exponent * model.gradient + prior_information.cwiseProduct(difference(prior->mean, pose));
    model.information *= prior->likelihood_exponent;
    model.information.diagonal() += prior_information;
  }
  Matrix6d information = model.information;
  information.diagonal().head<3>().array() += 1.0 / (kStepStddevM * kStepStddevM);
  information.diagonal().tail<3>().array() += 1.0 / (kStepStddevRad * kStepStddevRad);
  Vector6d step = information.ldlt().solve(model.gradient);
  if (!step.allFinite()) return;
  step /= std::max({1.0, step.head<3>().norm() / kMaxStepM, step.tail<3>().norm() / kMaxStepRad});
  pose = perturb(pose, step);
}

}  // namespace

Pose climbPosterior(PoseLikelihood& likelihood, const Pose& T_camera_centre, const ClimbPrior& prior, int steps,
                    int thread) {
  Pose pose = T_camera_centre;
  for (int k = 0; k < steps; ++k) takeStep(likelihood, 0.0, thread, pose, &prior);
  return pose;
}

Pose climbLikelihood(PoseLikelihood& likelihood, const Pose& T_camera_centre, const ClimbSchedule& schedule,
                     int thread) {
  Pose pose = T_camera_centre;
  for (double width = schedule.first_width_m; width > schedule.last_width_m; width *= kRatio) {
    takeStep(likelihood, width, thread, pose);
  }
  if (schedule.final_steps == 0) return pose;
  // A wide surface noise also pulls towards what touches the object: the start may have been better.
  Pose best = T_camera_centre;
  double highest = likelihood.logLikelihood(best, thread);
  for (int k = 0; k <= schedule.final_steps; ++k) {
    const double value = likelihood.logLikelihood(pose, thread);
    if (value > highest) {
      highest = value;
      best = pose;
    }
    if (k < schedule.final_steps) takeStep(likelihood, 0.0, thread, pose);
  }
  return best;
}

}  // namespace depth_object_tracker
