// SPDX-License-Identifier: BSD-3-Clause
// Finds where one frame's posterior is high: Gauss-Newton from several starts, and probes along directions depth leaves
// free.
#pragma once

#include "depth_object_tracker/filter/pose_likelihood.h"
#include "depth_object_tracker/model/process_model.h"

#include <optional>
#include <utility>
#include <vector>

namespace depth_object_tracker {

/// Local quadratic model of gamma * log L about a pose.
struct LocalMode {
  Pose pose = Pose::Identity();             ///< T_camera_centre
  Vector6d slope = Vector6d::Zero();        ///< of gamma * log L at `pose`
  Matrix6d information = Matrix6d::Zero();  ///< positive semi-definite
  double log_likelihood = 0.0;              ///< gamma * log L at `pose` [nat]
  double log_posterior = 0.0;               ///< ... plus the log prior density about the predicted mean
};

struct ModeSearchStart {
  Pose pose;
  double width_m;  ///< surface noise of the first step; halved from step to step
};

/// Prior of the frame that all starts share.
struct PredictedPose {
  Pose mean = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< spread of the particles' predictions, process noise not included
};

class ModeSearch {
 public:
  /// @param object_radius_m makes rotations comparable to translations when directions are ranked.
  ModeSearch(PoseLikelihood& likelihood, const ProcessStep& step, double likelihood_exponent, double object_radius_m);

  /// The best mode first, then others that compete with it (at most `max_modes`). Empty without starts.
  /// @param starts all climbed from. @param hypotheses of which only the most promising are.
  std::vector<LocalMode> run(const PredictedPose& predicted, const std::vector<ModeSearchStart>& starts,
                             const std::vector<Pose>& hypotheses, std::size_t max_modes);

 private:
  /// task(index, thread) for every index in [0, count), on the likelihood's threads.
  template <typename Task>
  void forEach(std::size_t count, const Task& task) const;
  bool isOutOfReach(const LocalMode& mode, const PredictedPose& predicted) const;
  std::vector<Pose> bestOf(const std::vector<Pose>& hypotheses) const;
  LocalMode climb(const PredictedPose& predicted, const ModeSearchStart& start, int thread) const;
  Vector6d newtonStep(const PredictedPose& predicted, const Matrix6d& prior_information, const Linearisation& model,
                      const Pose& pose) const;
  LocalMode exploreFreeDirections(const PredictedPose& predicted, LocalMode mode) const;
  /// Directions that the posterior leaves widest, and how far to probe along each [units of the direction].
  std::vector<std::pair<Vector6d, double>> freeDirections(const LocalMode& mode) const;
  /// Measures slope and curvature along them. @return a pose met on the way that is better than the mode.
  std::optional<Pose> probeFreeDirections(const PredictedPose& predicted, LocalMode& mode) const;
  std::optional<Pose> betterPose(const PredictedPose& predicted, const LocalMode& mode, const std::vector<Pose>& poses,
                                 const std::vector<double>& values) const;
  /// @param values of gamma * log L at kProbeOffsets * reach along `direction` from the mode.
  static void takeMeasuredCurvature(const Vector6d& direction, double reach, const double* values, LocalMode& mode);
  Matrix6d priorInformation(const PredictedPose& predicted) const;
  double logPrior(const Pose& pose, const PredictedPose& predicted) const;
  double temperedLogLikelihood(const Pose& pose, int thread) const;

  PoseLikelihood& likelihood_;
  const ProcessStep& step_;
  double exponent_;
  double object_radius_m_;
};

}  // namespace depth_object_tracker
