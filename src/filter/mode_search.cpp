// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/filter/mode_search.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace depth_object_tracker {
namespace {

constexpr double kNarrowestWidthM = 0.002;  // below: the model's own noise
constexpr int kFinalSteps = 4;              // with the model's own noise
constexpr double kMaxStepM = 0.03;
constexpr double kMaxStepRad = 0.35;
constexpr double kConvergedStep = 2e-5;  // m, and rad times the object's radius
constexpr double kFreeDirectionStddevM = 0.7e-3;
constexpr double kMaxProbeM = 0.02;
constexpr std::array<double, 4> kProbeOffsets = {-1.0, -0.5, 0.5, 1.0};  // of the reach
constexpr double kReachSquared = 16.0;       // squared Mahalanobis distance from the prediction
constexpr double kHypothesisWidthM = 0.012;  // hypotheses are judged and climbed from with this much tolerance
constexpr int kMaxExplorations = 2;
constexpr double kWorthMovingNat = 0.5;
constexpr double kSameModeM = 2e-3;     // modes nearer than this are one
constexpr double kCompetingNat = 12.0;  // modes less probable by more than this are dropped

void limitStep(Vector6d& step) {
  const double scale = std::max({1.0, step.head<3>().norm() / kMaxStepM, step.tail<3>().norm() / kMaxStepRad});
  step /= scale;
}

/// The most probable first; equal ones keep their order. std::stable_sort would ask the heap for memory.
template <typename Modes>
void sortByPosterior(Modes& modes) {
  for (auto mode = modes.begin(); mode != modes.end(); ++mode) {
    const auto place = std::upper_bound(modes.begin(), mode, *mode, [](const LocalMode& a, const LocalMode& b) {
      return a.log_posterior > b.log_posterior;
    });
    std::rotate(place, mode, mode + 1);
  }
}

/// Size of a displacement as the object's surface sees it [m].
double surfaceMotion(const Vector6d& displacement, double radius) {
  return std::hypot(displacement.head<3>().norm(), displacement.tail<3>().norm() * radius);
}

}  // namespace

ModeSearch::ModeSearch(PoseLikelihood& likelihood, const ProcessStep& step, double likelihood_exponent,
                       double object_radius_m)
    : likelihood_(likelihood), step_(step), exponent_(likelihood_exponent), object_radius_m_(object_radius_m) {}

void ModeSearch::run(const PredictedPose& predicted, const Starts& starts, const std::vector<Pose>& hypotheses,
                     std::size_t max_modes, std::vector<LocalMode>& modes) {
  InlineVector<ModeSearchStart, kMaxStarts + kClimbedHypotheses> climbed;
  for (const ModeSearchStart& start : starts) climbed.push_back(start);
  for (const Pose& hypothesis : bestOf(hypotheses)) climbed.push_back({hypothesis, kHypothesisWidthM});
  InlineVector<LocalMode, kMaxStarts + kClimbedHypotheses> found;
  found.resize(climbed.size());
  forEach(climbed.size(), [&](std::size_t i, int thread) { found[i] = climb(predicted, climbed[i], thread); });
  sortByPosterior(found);
  modes.clear();
  for (LocalMode& mode : found) {
    if (modes.size() == max_modes) break;
    if (!modes.empty() && mode.log_posterior < modes.front().log_posterior - kCompetingNat) break;
    const bool known = std::any_of(modes.begin(), modes.end(), [&](const LocalMode& other) {
      return surfaceMotion(difference(mode.pose, other.pose), object_radius_m_) < kSameModeM;
    });
    const bool is_in_view = std::isfinite(mode.log_likelihood);  // a climb may end outside of the region of interest
    if (known || !is_in_view || isOutOfReach(mode, predicted)) continue;
    modes.push_back(exploreFreeDirections(predicted, mode));
  }
}

template <typename Task>
void ModeSearch::forEach(std::size_t count, const Task& task) const {
  likelihood_.parallelFor(static_cast<int>(count),
                          [&task](int index, int thread) { task(static_cast<std::size_t>(index), thread); });
}

bool ModeSearch::isOutOfReach(const LocalMode& mode, const PredictedPose& predicted) const {
  // A flat board larger than the object fits one of its faces perfectly: only the process model says that it is too
  // far.
  const Vector6d displacement = difference(mode.pose, predicted.mean);
  return displacement.dot(priorInformation(predicted) * displacement) > kReachSquared;
}

std::vector<Pose> ModeSearch::bestOf(const std::vector<Pose>& hypotheses) const {
  std::vector<std::pair<double, std::size_t>> ranking(hypotheses.size());
  forEach(hypotheses.size(), [&](std::size_t i, int thread) {
    ranking[i] = {-likelihood_.broadLogLikelihood(hypotheses[i], kHypothesisWidthM, thread), i};
  });
  const std::size_t kept = std::min(ranking.size(), kClimbedHypotheses);
  std::partial_sort(ranking.begin(), ranking.begin() + static_cast<std::ptrdiff_t>(kept), ranking.end());
  std::vector<Pose> best;
  for (std::size_t k = 0; k < kept; ++k) best.push_back(hypotheses[ranking[k].second]);
  return best;
}

LocalMode ModeSearch::climb(const PredictedPose& predicted, const ModeSearchStart& start, int thread) const {
  const Matrix6d prior_information = priorInformation(predicted);
  LocalMode mode;
  mode.pose = start.pose;
  int final_steps = 0;
  for (double width = start.width_m; final_steps < kFinalSteps; width *= 0.5) {
    const bool is_final = width < kNarrowestWidthM;
    final_steps += is_final ? 1 : 0;
    const Linearisation model = likelihood_.linearise(mode.pose, is_final ? 0.0 : width, thread);
    Vector6d displacement = newtonStep(predicted, prior_information, model, mode.pose);
    limitStep(displacement);
    mode.pose = perturb(mode.pose, displacement);
    if (is_final && surfaceMotion(displacement, object_radius_m_) < kConvergedStep) break;
  }
  const Linearisation model = likelihood_.linearise(mode.pose, 0.0, thread);
  mode.slope = exponent_ * model.gradient;
  mode.information = exponent_ * model.information;
  mode.log_likelihood = temperedLogLikelihood(mode.pose, thread);
  mode.log_posterior = mode.log_likelihood + logPrior(mode.pose, predicted);
  return mode;
}

Vector6d ModeSearch::newtonStep(const PredictedPose& predicted, const Matrix6d& prior_information,
                                const Linearisation& model, const Pose& pose) const {
  const Matrix6d information = exponent_ * model.information + prior_information;
  const Vector6d slope = exponent_ * model.gradient + prior_information * difference(predicted.mean, pose);
  return information.ldlt().solve(slope);
}

Matrix6d ModeSearch::priorInformation(const PredictedPose& predicted) const {
  // The widest component: a sudden motion must be found too; the weights know how rare it is.
  Matrix6d covariance = predicted.covariance;
  covariance.diagonal() += step_.widestComponent().variances;
  return covariance.inverse();
}

double ModeSearch::logPrior(const Pose& pose, const PredictedPose& predicted) const {
  return step_.logDensity(difference(pose, predicted.mean));
}

double ModeSearch::temperedLogLikelihood(const Pose& pose, int thread) const {
  return exponent_ * likelihood_.logLikelihood(pose, thread);
}

LocalMode ModeSearch::exploreFreeDirections(const PredictedPose& predicted, LocalMode mode) const {
  // Depth inside of the outline says little about a face that slides in its own plane or a mug that turns about its
  // axis: the mode that was climbed may be one of several. Probes at the posterior's own scale find better ones and
  // measure curvature.
  for (int round = 0; round < kMaxExplorations; ++round) {
    LocalMode probed = mode;
    const std::optional<Pose> better = probeFreeDirections(predicted, probed);
    if (!better) return probed;
    const LocalMode climbed = climb(predicted, {*better, kNarrowestWidthM}, 0);
    if (climbed.log_posterior <= mode.log_posterior + kWorthMovingNat) return probed;
    mode = climbed;
  }
  probeFreeDirections(predicted, mode);
  return mode;
}

std::optional<Pose> ModeSearch::probeFreeDirections(const PredictedPose& predicted, LocalMode& mode) const {
  static_assert(kProbes == kProbeOffsets.size());
  const FreeDirections directions = freeDirections(mode);
  Probes probes;
  probes.resize(directions.size() * kProbes);
  forEach(probes.size(), [&](std::size_t i, int thread) {
    const FreeDirection& free = directions[i / kProbes];
    probes[i].pose = perturb(mode.pose, kProbeOffsets[i % kProbes] * free.reach * free.direction);
    probes[i].value = temperedLogLikelihood(probes[i].pose, thread);
  });
  std::optional<Pose> better = betterPose(predicted, mode, probes);
  for (std::size_t k = 0; k < directions.size(); ++k) takeMeasuredCurvature(directions[k], &probes[k * kProbes], mode);
  return better;
}

std::optional<Pose> ModeSearch::betterPose(const PredictedPose& predicted, const LocalMode& mode,
                                           const Probes& probes) const {
  std::optional<Pose> better;
  double best = mode.log_posterior + kWorthMovingNat;
  for (const Probe& probe : probes) {
    const double log_posterior = probe.value + logPrior(probe.pose, predicted);
    if (!(log_posterior > best)) continue;
    best = log_posterior;
    better = probe.pose;
  }
  return better;
}

ModeSearch::FreeDirections ModeSearch::freeDirections(const LocalMode& mode) const {
  Matrix6d information = mode.information;
  information.diagonal() += step_.component(0).variances.cwiseInverse();
  Vector6d scale = Vector6d::Ones();
  scale.tail<3>().setConstant(1.0 / object_radius_m_);  // rotations in metres of surface motion
  const Matrix6d scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> directions(scaled);
  FreeDirections result;
  for (int k = 0; k < kMaxFreeDirections; ++k) {  // eigenvalues ascend
    const double stddev = 1.0 / std::sqrt(std::max(directions.eigenvalues()[k], 1e-12));
    if (stddev < kFreeDirectionStddevM) break;
    result.push_back({scale.asDiagonal() * directions.eigenvectors().col(k), std::min(2.0 * stddev, kMaxProbeM)});
  }
  return result;
}

void ModeSearch::takeMeasuredCurvature(const FreeDirection& free, const Probe* probes, LocalMode& mode) {
  const Vector6d& direction = free.direction;
  const double reach = free.reach;
  // Least-squares parabola through five points at -h, -h/2, 0, h/2, h: y = y0 + a x + b x^2 with x = offset / h.
  const double centre = mode.log_likelihood;
  const double values[kProbes] = {probes[0].value, probes[1].value, probes[2].value, probes[3].value};
  const double linear = (-values[0] - 0.5 * values[1] + 0.5 * values[2] + values[3]) / 2.5;
  // Normal equations of [1, x^2]: mean of x^2 is 0.5, sum of squared deviations 0.875.
  const double quadratic = (0.5 * (values[0] + values[3]) - 0.25 * (values[1] + values[2]) - 0.5 * centre) / 0.875;
  const double measured = -2.0 * quadratic / (reach * reach);
  const double known = direction.dot(mode.information * direction);
  if (!(measured > known) || !std::isfinite(measured) || !std::isfinite(linear)) return;
  // Slope and information along the direction alone become the measured ones.
  const double squared = direction.squaredNorm();
  const Vector6d along = direction / squared;
  mode.information += (measured - known) * along * along.transpose();
  mode.slope += (linear / reach - mode.slope.dot(direction)) * along;
}

}  // namespace depth_object_tracker
