// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/look_alike_check.h"

#include "depth_object_tracker/filter/likelihood_climb.h"
#include "tracker/pose_evidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace depth_object_tracker {
namespace {

constexpr double kBroadM = 0.012;
constexpr ClimbSchedule kClimb = {kBroadM, 0.002, 5};
constexpr double kNearbyNat = 3.0, kSurelyNat = 8.0;
constexpr double kPromisingNat = 5.0, kPerhapsPromisingNat = 30.0;
constexpr std::size_t kPerImage = 8, kClimbsWhenNew = 3;
constexpr double kImpossibleNat = 4.0;  // what was known speaks against a turn
constexpr double kMostNat = 4.0;
constexpr double kWorthFollowingNat = 1.5;  // less is chance, in every image
constexpr double kForgottenHalfLifeS = 0.25;
constexpr std::array<double, 4> kSmallTurnsRad = {-0.2, -0.1, 0.1, 0.2};

/// Evidence [nat] that a turn needs: the farther, the surer.
double needed(const Pose& from, const Pose& to, const TurnPrior& prior) {
  const double turned = rotationAngle(from.linear().transpose() * to.linear()) / prior.stddev_rad;
  return kSurelyNat + 0.5 * turned * turned;
}

}  // namespace

void LookAlikeCheck::rankCandidates(DepthLikelihood& likelihood, const Pose& T_camera_centre) {
  const std::size_t count = std::min(kPerImage, look_alikes_.far.size());
  poses_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    poses_.push_back(T_camera_centre * look_alikes_.far[(next_ + i) % look_alikes_.far.size()]);
  }
  next_ = (next_ + count) % look_alikes_.far.size();
  if (pending_) poses_.push_back(T_camera_centre * pending_->T_centre_centre);
  poses_.push_back(T_camera_centre);
  likelihood.prepare(poses_);
  poses_.resize(count);
  candidates_.clear();
  for (const Pose& pose : poses_) candidates_.push_back({likelihood.broadLogLikelihood(pose, kBroadM, 0), pose});
  std::sort(candidates_.begin(), candidates_.end(),
            [](const Candidate& a, const Candidate& b) { return a.broad > b.broad; });
}

std::optional<Pose> LookAlikeCheck::findBetter(DepthLikelihood& likelihood, const Pose& T_camera_centre,
                                               double exponent, const TurnPrior& prior, double dt_s) {
  if (look_alikes_.far.empty()) return std::nullopt;
  illusions_.age(dt_s);
  if (std::optional<Pose> nearby = findNearby(likelihood, T_camera_centre, exponent)) return nearby;
  if (prior.was_followed) pending_.reset();
  rankCandidates(likelihood, T_camera_centre);
  const double now = likelihood.logLikelihood(T_camera_centre, 0);
  const auto evidence = [&](const Pose& pose) {
    const double nat = exponent * (likelihood.logLikelihood(pose, 0) - now);
    return std::abs(nat) > kWorthFollowingNat ? nat + outlineEvidence(likelihood, pose, T_camera_centre) : nat;
  };

  // Of a pose that was followed only what is as good already is worth the climb.
  const double least = likelihood.broadLogLikelihood(T_camera_centre, kBroadM, 0) -
                       (prior.was_followed ? kPromisingNat : kPerhapsPromisingNat) / exponent;
  const std::size_t climbs = prior.was_followed ? 1 : kClimbsWhenNew;
  std::optional<Pose> best;
  double found = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < std::min(climbs, candidates_.size()) && candidates_[i].broad > least; ++i) {
    const Pose climbed = climbLikelihood(likelihood, candidates_[i].pose, kClimb, 0);
    const double value = evidence(climbed);
    if (!(value > found)) continue;
    found = value;
    best = climbed;
  }
  if (best && found - illusions_.known(T_camera_centre.inverse() * *best) > needed(T_camera_centre, *best, prior)) {
    pending_.reset();
    return best;
  }
  if (best) learnIllusion(T_camera_centre.inverse() * *best, found, prior, dt_s);
  if (prior.was_followed) return std::nullopt;
  if (!pending_ && best && found > kWorthFollowingNat) pending_ = Pending{T_camera_centre.inverse() * *best, 0.0};
  return followPending(likelihood, T_camera_centre, prior, evidence, dt_s);
}

void LookAlikeCheck::learnIllusion(const Pose& T_centre_centre, double nat, const TurnPrior& prior, double dt_s) {
  const double turned = rotationAngle(T_centre_centre.linear()) / prior.stddev_rad;
  const double images = static_cast<double>(look_alikes_.far.size()) / static_cast<double>(kPerImage);
  const double since_last_s = dt_s * std::max(1.0, images);
  if (0.5 * turned * turned > kImpossibleNat) {
    illusions_.learn(T_centre_centre, nat, since_last_s);
  } else {
    illusions_.fade(T_centre_centre, nat, since_last_s);
  }
}

std::optional<Pose> LookAlikeCheck::findNearby(DepthLikelihood& likelihood, const Pose& T_camera_centre,
                                               double exponent) {
  constexpr ClimbSchedule kClimbNear = {0.004, 0.002, 5};
  const Pose* best = nullptr;
  poses_.clear();
  for (const ScrewAxis& axis : look_alikes_.axes) {
    for (const double turn : kSmallTurnsRad) poses_.push_back(T_camera_centre * turnAbout(axis, turn));
  }
  if (poses_.empty()) return std::nullopt;
  poses_.push_back(T_camera_centre);
  likelihood.prepare(poses_);
  poses_.pop_back();
  const double now = likelihood.logLikelihood(T_camera_centre, 0);
  double highest = now - kPromisingNat / exponent;
  for (const Pose& pose : poses_) {
    const double value = likelihood.logLikelihood(pose, 0);
    if (!(value > highest)) continue;
    highest = value;
    best = &pose;
  }
  if (best == nullptr) return std::nullopt;
  const Pose climbed = climbLikelihood(likelihood, *best, kClimbNear, 0);
  if (exponent * (likelihood.logLikelihood(climbed, 0) - now) < kNearbyNat) return std::nullopt;
  return climbed;
}

std::optional<Pose> LookAlikeCheck::followPending(DepthLikelihood& likelihood, const Pose& T_camera_centre,
                                                  const TurnPrior& prior,
                                                  const std::function<double(const Pose&)>& evidence, double dt_s) {
  if (!pending_) return std::nullopt;
  const Pose climbed = climbLikelihood(likelihood, T_camera_centre * pending_->T_centre_centre, kClimb, 0);
  pending_->T_centre_centre = T_camera_centre.inverse() * climbed;
  // Images in a row are wrong in the same way: none counts for much, and none for long.
  pending_->evidence = pending_->evidence * std::exp2(-dt_s / kForgottenHalfLifeS) +
                       std::clamp(evidence(climbed), -kMostNat, kMostNat) - kWorthFollowingNat;
  const bool is_other = rotationAngle(pending_->T_centre_centre.linear()) > 0.5 * kLookAlikesApartRad;
  const bool is_better = pending_->evidence > needed(T_camera_centre, climbed, prior);
  if (is_better || !is_other || pending_->evidence <= 0.0) pending_.reset();
  if (!is_better) return std::nullopt;
  return climbed;
}

}  // namespace depth_object_tracker
