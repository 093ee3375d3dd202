// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/filter/informed_proposal.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

// A little wider than the local model: importance weights stay bounded where the true posterior has heavier tails.
constexpr double kCovarianceInflation = 1.3;
// No component is proposed more rarely than this: the local model may misjudge a mode's mass.
constexpr double kMinShare = 0.03;

double logSum(double a, double b) {
  const double larger = std::max(a, b);
  if (!std::isfinite(larger)) return larger;
  return larger + std::log(std::exp(a - larger) + std::exp(b - larger));
}

}  // namespace

InformedProposal::InformedProposal(const ProcessStep& step, const std::vector<LocalMode>& modes) {
  for (std::size_t j = 0; j < std::min(modes.size(), kMaxModes); ++j) modes_.push_back(modes[j]);
  for (std::size_t j = 0; j < modes_.size(); ++j) {
    for (int k = 0; k < step.numComponents(); ++k) {
      Component& component = components_[num_components_++];
      component.mode = j;
      component.log_weight = std::log(step.component(k).weight) + modes_[j].log_likelihood;
      component.prior_information = step.component(k).variances.cwiseInverse();
      component.precision = modes_[j].information;
      component.precision.diagonal() += component.prior_information;
      component.covariance = component.precision.inverse();
      component.covariance = 0.5 * (component.covariance + component.covariance.transpose().eval());
      component.shape = Gaussian6(Vector6d::Zero(), kCovarianceInflation * component.covariance);
      component.log_determinant_ratio =
          0.5 * (component.prior_information.array().log().sum() - std::log(component.precision.determinant()));
    }
  }
  if (num_components_ > 0) {
    data_share_ = Matrix6d::Identity() - components_[0].covariance * components_[0].prior_information.asDiagonal();
  }
}

InformedProposal::ForParticle::ForParticle(const InformedProposal& proposal, const Pose& predicted)
    : proposal_(proposal) {
  double largest = -1e300;
  for (std::size_t c = 0; c < proposal_.num_components_; ++c) {
    const Component& component = proposal_.components_[c];
    const LocalMode& mode = proposal_.modes_[component.mode];
    const Vector6d mu = difference(predicted, mode.pose);
    const Vector6d pull = component.prior_information.cwiseProduct(mu);
    means_[c] = component.covariance * (mode.slope + pull);
    // Evidence of the quadratic model under this prior: the mass that the component should get.
    const double exponent = 0.5 * means_[c].dot(component.precision * means_[c]) - 0.5 * mu.dot(pull);
    log_shares_[c] = component.log_weight + component.log_determinant_ratio + exponent;
    largest = std::max(largest, log_shares_[c]);
  }
  double sum = 0.0;
  for (std::size_t c = 0; c < proposal_.num_components_; ++c) sum += std::exp(log_shares_[c] - largest);
  log_evidence_ = largest + std::log(sum);
  const double floor = kMinShare, rest = 1.0 - kMinShare * static_cast<double>(proposal_.num_components_);
  for (std::size_t c = 0; c < proposal_.num_components_; ++c) {
    log_shares_[c] = std::log(floor + rest * std::exp(log_shares_[c] - largest) / sum);
  }
}

Pose InformedProposal::ForParticle::sample(double choice, const Vector6d& standard_normal) const {
  std::size_t c = 0;
  for (double left = choice - std::exp(log_shares_[0]); left > 0.0 && c + 1 < proposal_.num_components_;) {
    ++c;
    left -= std::exp(log_shares_[c]);
  }
  const Component& component = proposal_.components_[c];
  return perturb(proposal_.modes_[component.mode].pose, means_[c] + component.shape.sample(standard_normal));
}

double InformedProposal::ForParticle::logDensity(const Pose& pose) const {
  double log_density = -std::numeric_limits<double>::infinity();
  std::size_t chart = kMaxModes;
  Vector6d displacement;
  double volume = 0.0;
  for (std::size_t c = 0; c < proposal_.num_components_; ++c) {
    const Component& component = proposal_.components_[c];
    if (component.mode != chart) {
      chart = component.mode;
      displacement = difference(pose, proposal_.modes_[chart].pose);
      volume = logRotationVolume(displacement.tail<3>());
    }
    log_density = logSum(log_density, log_shares_[c] + component.shape.logDensity(displacement - means_[c]) - volume);
  }
  return log_density;
}

void InformedProposal::ForParticle::addTo(MixtureMoments& moments, double particle_weight) const {
  if (!(particle_weight > 0.0)) return;
  const double log_weight = std::log(particle_weight) + log_evidence_;
  for (std::size_t c = 0; c < proposal_.num_components_; ++c) {
    const Component& component = proposal_.components_[c];
    const Vector6d mean = component.mode == 0 ? means_[c]
                                              : difference(perturb(proposal_.modes_[component.mode].pose, means_[c]),
                                                           proposal_.modes_[0].pose);
    moments.add(log_weight + log_shares_[c], mean, component.covariance);
  }
}

}  // namespace depth_object_tracker
