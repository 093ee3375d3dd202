// SPDX-License-Identifier: BSD-3-Clause
// Proposal of every particle: its own process prior times the local models of the frame's likelihood.
#pragma once

#include "depth_object_tracker/filter/gaussian6.h"
#include "depth_object_tracker/filter/mixture_moments.h"
#include "depth_object_tracker/filter/mode_search.h"

#include <array>
#include <vector>

namespace depth_object_tracker {

/// q(r | particle) = sum_jk c_jk N(r; m_jk, S_jk) over modes j and process components k, in mode j's chart, where
/// S = (A_j + Q_k^-1)^-1 and m = S (b_j + Q_k^-1 mu) with the particle's prediction mu. Where a mode's quadratic model
/// is exact this is the optimal proposal: weights do not depend on the draw.
class InformedProposal {
 public:
  static constexpr std::size_t kMaxModes = 2;
  static constexpr std::size_t kMaxComponents = kMaxModes * ProcessStep::kMaxComponents;

  /// @param modes at most kMaxModes, best first. Empty: only the process model is left.
  InformedProposal(const ProcessStep& step, const std::vector<LocalMode>& modes);

  bool empty() const { return num_components_ == 0; }

  /// Proposal of one particle.
  class ForParticle {
   public:
    ForParticle(const InformedProposal& proposal, const Pose& predicted);
    /// @param choice uniform in (0, 1) picks the component.
    Pose sample(double choice, const Vector6d& standard_normal) const;
    /// Log density [nat] with respect to translation times rotation volume (independent of the chart).
    double logDensity(const Pose& pose) const;
    /// Adds the components, in the best mode's chart, each as likely as the particle and the local models make it.
    void addTo(MixtureMoments& moments, double particle_weight) const;

   private:
    const InformedProposal& proposal_;
    double log_evidence_ = 0.0;
    std::array<Vector6d, kMaxComponents> means_;
    std::array<double, kMaxComponents> log_shares_;
  };

  /// Share of a displacement that the best mode's data, rather than the prior, determine: I - S Q^-1.
  const Matrix6d& dataShare() const { return data_share_; }

 private:
  struct Component {
    std::size_t mode;
    double log_weight;           // process component's weight and mode's height
    Vector6d prior_information;  // diagonal of Q_k^-1
    Matrix6d covariance;         // S
    Matrix6d precision;
    Gaussian6 shape;               // N(0, inflated S)
    double log_determinant_ratio;  // log(|S| / |Q|) / 2
  };

  InlineVector<LocalMode, kMaxModes> modes_;
  std::array<Component, kMaxComponents> components_;
  std::size_t num_components_ = 0;
  Matrix6d data_share_ = Matrix6d::Zero();
};

}  // namespace depth_object_tracker
