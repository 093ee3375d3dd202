// SPDX-License-Identifier: BSD-3-Clause
// The particle filter over poses: predict, propose, weight, estimate, resample.
#pragma once

#include "depth_object_tracker/filter/filter_config.h"
#include "depth_object_tracker/filter/mode_search.h"
#include "depth_object_tracker/filter/pose_likelihood.h"
#include "depth_object_tracker/filter/pose_statistics.h"
#include "depth_object_tracker/filter/random.h"
#include "depth_object_tracker/geometry/symmetry.h"
#include "depth_object_tracker/model/process_model.h"

#include <functional>
#include <optional>
#include <vector>

namespace depth_object_tracker {

struct FilterTimes {
  double proposal_s = 0.0;
  double likelihood_s = 0.0;
  double resample_s = 0.0;
};

/// Posterior after one frame, about the object's centre.
struct FilterEstimate {
  PoseStatistics pose;
  Vector6d velocity = Vector6d::Zero();  ///< [m/s, rad/s]
  Matrix6d velocity_covariance = Matrix6d::Zero();
  double effective_sample_size = 0.0;
  int pose_evaluations = 0;
  FilterTimes time;
};

/// Poses of the centre where the object may be besides where it is expected.
struct Hypotheses {
  std::vector<Pose> always;
  std::vector<Pose> if_poor;  ///< only when the best mode found without them does not explain what is seen
};

/// Target: product over frames of L^gamma times the process model. Knows nothing of images.
class ParticleFilter {
 public:
  /// @param object_radius_m size of the object, makes rotations comparable to translations.
  /// @param symmetries about the centre frame; equivalent poses are folded together.
  ParticleFilter(const FilterConfig& config, double object_radius_m, Symmetries symmetries);

  /// Puts all particles at one pose, at rest; the first update's ProcessStep brings the initial uncertainty.
  void initialise(const Pose& T_camera_centre);

  /// From the next update on. @param count >= 1
  void setNumParticles(int count) { wanted_particles_ = static_cast<std::size_t>(count); }

  /// One frame. @param likelihood_exponent gamma in (0, 1].
  /// @param hypotheses further poses to look at: always (at the start, after a loss), or if what was found without
  /// them fits poorly.
  FilterEstimate update(PoseLikelihood& likelihood, const ProcessStep& step, double likelihood_exponent,
                        const Hypotheses& hypotheses = {});

  /// One frame that says nothing of the pose: the particles move as the process has it, without weighing.
  FilterEstimate hold(PoseLikelihood& likelihood, const ProcessStep& step);

  /// Takes the last update() back, but for its resampling.
  void undo();

  /// Before resampling.
  const std::vector<Pose>& poses() const { return poses_; }
  const std::vector<double>& weights() const { return weights_; }

  /// Velocities become zero (after a time jump or a gap).
  void stopMotion();

  /// Moves all particles in their own axes. @param T_before_now p_before = T p_now, in object axes about the centre.
  void moveInObject(const Pose& T_before_now);

  /// Adds to all velocities [m/s, rad/s]: what they are relative to has changed.
  void shiftVelocities(const Vector6d& shift);
  /// Changes each particle's velocity. @param change of a velocity [m/s, rad/s, camera axes] at a pose T_camera_centre.
  void changeVelocities(const std::function<Vector6d(const Vector6d&, const Pose&)>& change);
  /// Tells all that is remembered in the axes of a camera that has moved. @param T_now_before p_now = T p_before.
  void moveCamera(const Pose& T_now_before);

 private:
  void summarise(FilterEstimate& estimate, const ProcessStep& step);
  void resampleIfNeeded(PoseLikelihood& likelihood);
  void predict(const ProcessStep& step);
  /// Fills modes_.
  void findModes(PoseLikelihood& likelihood, const ProcessStep& step, double exponent, const Hypotheses& hypotheses);
  void drawFromProcess(const ProcessStep& step);
  void drawInformed(const ProcessStep& step);
  void foldSymmetries();
  void updateVelocities(const ProcessStep& step);
  void estimateVelocity(FilterEstimate& estimate) const;
  Pose drawPrior(const ProcessStep& step, std::size_t particle) const;
  Vector6d normalDraw(std::size_t particle) const;
  double choiceDraw(std::size_t particle) const;

  FilterConfig config_;
  double object_radius_m_;
  Symmetries symmetries_;
  CounterRandom random_;
  std::uint64_t frame_ = 0;

  std::size_t wanted_particles_;
  std::vector<Pose> poses_;           // T_camera_centre
  std::vector<Vector6d> velocities_;  // of the centre
  std::vector<double> weights_;       // sum 1
  std::vector<Pose> poses_before_;    // the last update: see undo()
  std::vector<Vector6d> velocities_before_;
  std::vector<double> weights_before_;
  Pose last_mean_before_ = Pose::Identity();
  std::vector<Pose> predicted_;
  std::vector<double> log_proposal_ratio_;  // log p(r | r_prev) - log q(r)
  std::vector<double> log_likelihoods_;
  std::vector<double> log_weights_;
  std::optional<PoseStatistics> expected_;  // posterior as the local models have it; none without them
  std::vector<LocalMode> modes_;            // of this frame
  std::vector<LocalMode> modes_nearby_;     // scratch
  // Scratch, kept so that a frame allocates nothing.
  std::vector<Pose> region_;
  std::vector<int> offspring_, source_;
  Matrix6d data_share_ = Matrix6d::Identity();
  Pose last_mean_ = Pose::Identity();
};

}  // namespace depth_object_tracker
