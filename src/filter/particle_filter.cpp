// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/filter/particle_filter.h"

#include "depth_object_tracker/filter/informed_proposal.h"
#include "depth_object_tracker/filter/resampling.h"
#include "depth_object_tracker/filter/stopwatch.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

// Share of what the data say about a particle's displacement that goes into its velocity.
constexpr double kVelocityGain = 0.7;
constexpr double kNarrowWidthM = 0.003;
constexpr double kBroadWidthM = 0.016;
constexpr std::size_t kMaxModes = InformedProposal::kMaxModes;

}  // namespace

ParticleFilter::ParticleFilter(const FilterConfig& config, double object_radius_m, Symmetries symmetries)
    : config_(config), object_radius_m_(object_radius_m), symmetries_(std::move(symmetries)), random_(config.seed) {
  const auto count = static_cast<std::size_t>(config.num_particles);
  wanted_particles_ = count;
  poses_.assign(count, Pose::Identity());
  velocities_.assign(count, Vector6d::Zero());
  weights_.assign(count, 1.0 / static_cast<double>(count));
  predicted_ = poses_;
  log_proposal_ratio_.assign(count, 0.0);
}

void ParticleFilter::initialise(const Pose& T_camera_centre) {
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    poses_[i] = T_camera_centre;
    velocities_[i].setZero();
    weights_[i] = 1.0 / static_cast<double>(poses_.size());
  }
  last_mean_ = T_camera_centre;
}

void ParticleFilter::stopMotion() {
  for (Vector6d& velocity : velocities_) velocity.setZero();
}

void ParticleFilter::shiftVelocities(const Vector6d& shift) {
  for (Vector6d& velocity : velocities_) velocity += shift;
}

void ParticleFilter::changeVelocities(const std::function<Vector6d(const Vector6d&, const Pose&)>& change) {
  for (std::size_t i = 0; i < poses_.size(); ++i) velocities_[i] = change(velocities_[i], poses_[i]);
}

void ParticleFilter::moveInObject(const Pose& T_before_now) {
  for (Pose& pose : poses_) pose = pose * T_before_now;
  last_mean_ = last_mean_ * T_before_now;
}

void ParticleFilter::moveCamera(const Pose& T_now_before) {
  for (Pose& pose : poses_) pose = T_now_before * pose;
  for (Vector6d& velocity : velocities_) velocity = rotated(velocity, T_now_before.linear());
  last_mean_ = T_now_before * last_mean_;
}

FilterEstimate ParticleFilter::update(PoseLikelihood& likelihood, const ProcessStep& step, double likelihood_exponent,
                                      const Hypotheses& hypotheses) {
  FilterEstimate estimate;
  Stopwatch stopwatch;
  ++frame_;
  resampleIfNeeded(likelihood);
  estimate.time.resample_s = stopwatch.lap();
  poses_before_ = poses_;
  velocities_before_ = velocities_;
  weights_before_ = weights_;
  last_mean_before_ = last_mean_;

  predict(step);
  if (config_.proposal == Proposal::kInformed) {
    findModes(likelihood, step, likelihood_exponent, hypotheses);
    drawInformed(step);
  } else {
    drawFromProcess(step);
  }
  estimate.time.proposal_s = stopwatch.lap();

  likelihood.update(poses_, log_likelihoods_);
  estimate.pose_evaluations += static_cast<int>(poses_.size());
  estimate.time.likelihood_s = stopwatch.lap();

  log_weights_.resize(poses_.size());
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    log_weights_[i] = std::log(weights_[i]) + likelihood_exponent * log_likelihoods_[i] + log_proposal_ratio_[i];
  }
  normaliseLogWeights(log_weights_, weights_);
  summarise(estimate, step);
  return estimate;
}

FilterEstimate ParticleFilter::hold(PoseLikelihood& likelihood, const ProcessStep& step) {
  FilterEstimate estimate;
  ++frame_;
  predict(step);
  drawFromProcess(step);
  data_share_.setZero();
  likelihood.prepare(poses_);
  summarise(estimate, step);
  return estimate;
}

void ParticleFilter::undo() {
  poses_ = poses_before_;
  velocities_ = velocities_before_;
  weights_ = weights_before_;
  last_mean_ = last_mean_before_;
}

void ParticleFilter::summarise(FilterEstimate& estimate, const ProcessStep& step) {
  foldSymmetries();
  estimate.pose = poseStatistics(poses_, weights_, last_mean_);
  estimate.effective_sample_size = effectiveSampleSize(weights_);
  if (expected_) {
    expected_->mean = foldOntoReference(expected_->mean, estimate.pose.mean, symmetries_);
    estimate.pose.covariance = completedCovariance(estimate.pose, estimate.effective_sample_size, *expected_);
  }
  updateVelocities(step);
  estimateVelocity(estimate);
  last_mean_ = estimate.pose.mean;
}

void ParticleFilter::resampleIfNeeded(PoseLikelihood& likelihood) {
  const std::size_t count = wanted_particles_;
  const double enough = config_.resampling_threshold * static_cast<double>(poses_.size());
  const bool every_frame = config_.resampling_threshold >= 1.0;
  if (!every_frame && count == poses_.size() && effectiveSampleSize(weights_) >= enough) return;
  const double offset = random_.uniform(RandomPurpose::kResampling, frame_, 0);
  resampleSystematic(weights_, offset, count, offspring_, source_);
  poses_.resize(std::max(poses_.size(), count));
  velocities_.resize(poses_.size());
  for (std::size_t slot = 0; slot < source_.size(); ++slot) {
    const auto from = static_cast<std::size_t>(source_[slot]);
    poses_[slot] = poses_[from];
    velocities_[slot] = velocities_[from];
  }
  poses_.resize(count);
  velocities_.resize(count);
  predicted_.resize(count);
  log_proposal_ratio_.resize(count);
  likelihood.resample(source_);
  weights_.assign(count, 1.0 / static_cast<double>(count));
}

void ParticleFilter::predict(const ProcessStep& step) {
  for (std::size_t i = 0; i < poses_.size(); ++i) predicted_[i] = step.predict(poses_[i], velocities_[i]);
}

void ParticleFilter::findModes(PoseLikelihood& likelihood, const ProcessStep& step, double exponent,
                               const Hypotheses& hypotheses) {
  const PoseStatistics predicted = poseStatistics(predicted_, weights_, last_mean_);
  ModeSearch::Starts starts;
  for (const double width : {kNarrowWidthM, kBroadWidthM}) starts.push_back({predicted.mean, width});
  if ((last_mean_.translation() - predicted.mean.translation()).norm() > 0.5 * kBroadWidthM) {
    starts.push_back({last_mean_, kBroadWidthM});  // the motion may have stopped
  }

  // The region of interest: all predictions and starts, and as far as a sudden motion reaches.
  region_ = predicted_;
  for (const ModeSearchStart& start : starts) region_.push_back(start.pose);
  region_.insert(region_.end(), hypotheses.always.begin(), hypotheses.always.end());
  const double reach = 2.0 * std::sqrt(step.widestComponent().variances.head<3>().maxCoeff());
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-reach, reach}) {
      region_.push_back(predicted.mean);
      region_.back().translation()[axis] += side;
    }
  }
  likelihood.prepare(region_);

  ModeSearch search(likelihood, step, exponent, object_radius_m_);
  const PredictedPose expected = {predicted.mean, predicted.covariance};
  search.run(expected, starts, hypotheses.always, kMaxModes, modes_);
  const bool is_poor = modes_.empty() || !likelihood.explains(modes_.front().pose);
  if (!is_poor || hypotheses.if_poor.empty()) return;
  region_.insert(region_.end(), hypotheses.if_poor.begin(), hypotheses.if_poor.end());
  likelihood.prepare(region_);
  modes_nearby_ = modes_;
  for (const LocalMode& mode : modes_) starts.push_back({mode.pose, kNarrowWidthM});
  search.run(expected, starts, hypotheses.if_poor, kMaxModes, modes_);
  // Far off, much of the image is explained badly by something: likelier, but no better than what is there already.
  const auto is_no_better = [&likelihood](const LocalMode& mode) { return !likelihood.explains(mode.pose); };
  if (modes_nearby_.empty()) return;
  modes_.erase(std::remove_if(modes_.begin(), modes_.end(), is_no_better), modes_.end());
  if (modes_.empty()) modes_ = modes_nearby_;
}

Vector6d ParticleFilter::normalDraw(std::size_t particle) const {
  // Antithetic pairs: the mean of the draws is exact, each draw alone is still normal.
  const Vector6d normal = random_.normal6(RandomPurpose::kProposal, frame_, static_cast<std::uint32_t>(particle / 2));
  return particle % 2 == 0 ? normal : Vector6d(-normal);
}

double ParticleFilter::choiceDraw(std::size_t particle) const {
  // Golden-ratio sequence from a random start: each choice alone is uniform, together they are evenly spread.
  constexpr double kGoldenRatio = 0.6180339887498949;
  const double start = random_.uniform(RandomPurpose::kComponent, frame_, 0);
  const double value = start + kGoldenRatio * static_cast<double>(particle);
  return value - std::floor(value);
}

Pose ParticleFilter::drawPrior(const ProcessStep& step, std::size_t particle) const {
  const double choice = random_.uniform(RandomPurpose::kComponent, frame_, static_cast<std::uint32_t>(particle + 1));
  const int k = step.numComponents() > 1 && choice > step.component(0).weight ? 1 : 0;
  const Vector6d displacement = step.component(k).variances.cwiseSqrt().cwiseProduct(normalDraw(particle));
  return perturb(predicted_[particle], displacement);
}

void ParticleFilter::drawFromProcess(const ProcessStep& step) {
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    poses_[i] = drawPrior(step, i);
    log_proposal_ratio_[i] = 0.0;
  }
  data_share_.setIdentity();
  expected_.reset();
}

void ParticleFilter::drawInformed(const ProcessStep& step) {
  const InformedProposal proposal(step, modes_);
  if (proposal.empty()) {
    drawFromProcess(step);
    // Few draws from the process explain the image, often one: the others say how far from the truth that may be.
    expected_ = poseStatistics(poses_, weights_, last_mean_);
    return;
  }
  const double prior_share = config_.prior_share;
  MixtureMoments moments;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const InformedProposal::ForParticle informed(proposal, predicted_[i]);
    informed.addTo(moments, weights_[i]);
    const double choice = choiceDraw(i);
    poses_[i] = choice < prior_share ? drawPrior(step, i)
                                     : informed.sample((choice - prior_share) / (1.0 - prior_share), normalDraw(i));
    const Vector6d displacement = difference(poses_[i], predicted_[i]);
    const double log_prior = step.logDensity(displacement) - logRotationVolume(displacement.tail<3>());
    // log of p / (alpha p + (1 - alpha) q)
    const double log_informed = informed.logDensity(poses_[i]);
    log_proposal_ratio_[i] = -std::log(prior_share + (1.0 - prior_share) * std::exp(log_informed - log_prior));
  }
  data_share_ = proposal.dataShare();
  expected_ = PoseStatistics{perturb(modes_.front().pose, moments.mean()), moments.covariance()};
}

void ParticleFilter::foldSymmetries() {
  if (symmetries_.empty()) return;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const Pose folded = foldOntoReference(poses_[i], last_mean_, symmetries_);
    predicted_[i] = foldOntoReference(predicted_[i], folded, symmetries_);
    poses_[i] = folded;
  }
}

void ParticleFilter::updateVelocities(const ProcessStep& step) {
  if (step.dt() <= 0.0) return;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const Vector6d surprise = difference(poses_[i], predicted_[i]) / step.dt();
    velocities_[i] = step.dampedVelocity(velocities_[i]) + kVelocityGain * (data_share_ * surprise);
  }
}

void ParticleFilter::estimateVelocity(FilterEstimate& estimate) const {
  for (std::size_t i = 0; i < poses_.size(); ++i) estimate.velocity += weights_[i] * velocities_[i];
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const Vector6d deviation = velocities_[i] - estimate.velocity;
    estimate.velocity_covariance += weights_[i] * deviation * deviation.transpose();
  }
}

}  // namespace depth_object_tracker
