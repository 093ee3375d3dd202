// SPDX-License-Identifier: BSD-3-Clause
// Finds where one frame's posterior is high: Gauss-Newton from several starts, and probes along directions depth leaves
// free.
#pragma once

#include "depth_object_tracker/filter/inline_vector.h"
#include "depth_object_tracker/filter/pose_likelihood.h"
#include "depth_object_tracker/model/process_model.h"

#include <optional>
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
  Pose pose = Pose::Identity();
  double width_m = 0.0;  ///< surface noise of the first step; halved from step to step
};

/// Prior of the frame that all starts share.
struct PredictedPose {
  Pose mean = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< spread of the particles' predictions, process noise not included
};

/// Does not ask the heap for memory while there are no hypotheses.
class ModeSearch {
 public:
  static constexpr std::size_t kMaxStarts = 5;
  using Starts = InlineVector<ModeSearchStart, kMaxStarts>;

  /// @param object_radius_m makes rotations comparable to translations when directions are ranked.
  ModeSearch(PoseLikelihood& likelihood, const ProcessStep& step, double likelihood_exponent, double object_radius_m);

  /// @param starts all climbed from. @param hypotheses of which only the most promising are.
  /// @param[out] modes the best one first, then others that compete with it (at most `max_modes`); empty without
  /// starts.
  void run(const PredictedPose& predicted, const Starts& starts, const std::vector<Pose>& hypotheses,
           std::size_t max_modes, std::vector<LocalMode>& modes);

 private:
  static constexpr int kMaxFreeDirections = 3;
  static constexpr std::size_t kProbes = 4;  // along each
  static constexpr std::size_t kClimbedHypotheses = 6;
  struct FreeDirection {
    Vector6d direction = Vector6d::Zero();
    double reach = 0.0;  // how far to probe [units of the direction]
  };
  struct Probe {
    Pose pose = Pose::Identity();
    double value = 0.0;  // gamma * log L
  };
  using FreeDirections = InlineVector<FreeDirection, kMaxFreeDirections>;
  using Probes = InlineVector<Probe, kMaxFreeDirections * kProbes>;

  /// task(index, thread) for every index in [0, count), on the likelihood's threads.
  template <typename Task>
  void forEach(std::size_t count, const Task& task) const;
  bool isOutOfReach(const LocalMode& mode, const PredictedPose& predicted) const;
  std::vector<Pose> bestOf(const std::vector<Pose>& hypotheses) const;
  LocalMode climb(const PredictedPose& predicted, const ModeSearchStart& start, int thread) const;
  Vector6d newtonStep(const PredictedPose& predicted, const Matrix6d& prior_information, const Linearisation& model,
                      const Pose& pose) const;
  LocalMode exploreFreeDirections(const PredictedPose& predicted, LocalMode mode) const;
  /// Directions that the posterior leaves widest.
  FreeDirections freeDirections(const LocalMode& mode) const;
  /// Measures slope and curvature along them. @return a pose met on the way that is better than the mode.
  std::optional<Pose> probeFreeDirections(const PredictedPose& predicted, LocalMode& mode) const;
  std::optional<Pose> betterPose(const PredictedPose& predicted, const LocalMode& mode, const Probes& probes) const;
  /// @param probes kProbes, at kProbeOffsets * reach along the direction from the mode.
  static void takeMeasuredCurvature(const FreeDirection& free, const Probe* probes, LocalMode& mode);
  Matrix6d priorInformation(const PredictedPose& predicted) const;
  double logPrior(const Pose& pose, const PredictedPose& predicted) const;
  double temperedLogLikelihood(const Pose& pose, int thread) const;

  PoseLikelihood& likelihood_;
  const ProcessStep& step_;
  double exponent_;
  double object_radius_m_;
};

}  // namespace depth_object_tracker
