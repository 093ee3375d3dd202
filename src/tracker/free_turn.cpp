// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/free_turn.h"

#include "depth_object_tracker/geometry/pose.h"
#include "tracker/pose_evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depth_object_tracker {
namespace {

constexpr int kStepsPerHalfTurn = AngleBelief::kSteps / 2;
constexpr double kStepRad = M_PI / kStepsPerHalfTurn;
constexpr double kContradictedNat = 3.0;  // less is chance
constexpr double kMostAgainstNat = 6.0;   // of one image
constexpr double kNegligibleShare = 1e-3;

constexpr double kGoodShare = 0.5;  // of the likeliest angle's
constexpr double kJumpRad = 0.4;    // in one image: no motion
constexpr int kLeastStepsToTurn = 8;
constexpr double kLeastTurnRad = 0.005;
constexpr double kRateHalfLifeS = 0.2;
constexpr double kDoubtedAbove = 1e-4;                        // [rad^2]
constexpr double kWrongShare = 0.1, kDoubtedHalfLifeS = 1.0;  // of turns to what looks alike

/// An object turns about the axis that is not shown as fast as it does about the others, for a while one way.
double grownBy(const FreeTurn::Motion& motion, const Eigen::Vector3d& axis_in_camera) {
  constexpr double kOneWayS = 0.15;
  const double across = motion.angular_velocity.cross(axis_in_camera).squaredNorm() / 2.0;
  return motion.process_variance_rad2 + 2.0 * kOneWayS * motion.dt_s * across;
}

}  // namespace

FreeTurn::FreeTurn(const std::vector<ScrewAxis>& axes) {
  for (const ScrewAxis& axis : axes) {
    axes_.emplace_back();
    axes_.back().axis = axis;
  }
}

void FreeTurn::restart(double stddev_rad) {
  for (Axis& axis : axes_) {
    axis.belief.restart(stddev_rad);
    axis.is_free = true;
    axis.rate = axis.doubted = 0.0;
  }
}

std::optional<Pose> FreeTurn::update(DepthLikelihood& likelihood, const Pose& predicted, const Pose& estimate,
                                     double exponent, const Motion& motion) {
  if (axes_.empty()) return std::nullopt;
  prepare(likelihood, estimate);
  const Eigen::Vector3d surprise = logSo3(predicted.linear().transpose() * estimate.linear());
  std::optional<Pose> turn;
  for (Axis& axis : axes_) {
    axis.doubted *= std::exp2(-motion.dt_s / kDoubtedHalfLifeS);
    const double farther = axis.axis.direction.dot(surprise);
    axis.belief.turnEstimate(farther);
    axis.belief.diffuse(grownBy(motion, estimate.linear() * axis.axis.direction));
    const Look look = this->look(likelihood, estimate, exponent, axis);
    axis.is_free = look.allowed > 0;
    axis.rate *= std::exp2(-motion.dt_s / kRateHalfLifeS);
    if (!axis.is_free) axis.rate = motion.angular_velocity.dot(estimate.linear() * axis.axis.direction);
    if (std::abs(farther) > kJumpRad) axis.rate = 0.0;
    // As long as where it should be is a good guess the estimate stays there: the mean would wander to the middle of
    // what may be, as far as the angle spreads.
    const bool is_good = axis.belief.near(-farther) > kGoodShare * axis.belief.peak();
    const double angle = is_good ? -farther : axis.belief.moments().mean;
    const bool may_turn = look.allowed >= kLeastStepsToTurn || look.is_contradicted;
    if (!may_turn || std::abs(angle) < kLeastTurnRad) continue;
    axis.belief.turnEstimate(angle);
    turn = turnAbout(axis.axis, angle);
  }
  return turn;
}

void FreeTurn::prepare(DepthLikelihood& likelihood, const Pose& estimate) {
  region_.clear();
  for (const Axis& axis : axes_) {
    for (int k = 0; k < AngleBelief::kSteps; ++k) region_.push_back(estimate * turnAbout(axis.axis, k * kStepRad));
  }
  likelihood.prepare(region_);
}

FreeTurn::Look FreeTurn::look(DepthLikelihood& likelihood, const Pose& estimate, double exponent, Axis& axis) {
  const auto at = [&](double angle) { return estimate * turnAbout(axis.axis, angle); };
  const double now = exponent * likelihood.logLikelihood(estimate, 0);
  evidence_.fill(-std::numeric_limits<double>::infinity());
  evidence_[0] = now;
  double best = now, best_angle = 0.0;
  Look look;
  for (const int way : {-1, 1}) {
    bool is_next = true;  // to the estimate, with nothing in between that is contradicted
    for (int k = 1; k <= kStepsPerHalfTurn; ++k) {
      const double angle = way * k * kStepRad;
      const bool is_believed = axis.belief.near(angle) > kNegligibleShare;
      if (!is_next && !is_believed) continue;
      const double there = exponent * likelihood.logLikelihood(at(angle), 0);
      evidence_[static_cast<std::size_t>((way * k + AngleBelief::kSteps) % AngleBelief::kSteps)] = there;
      is_next = is_next && now - there < kContradictedNat;
      if (is_next) ++look.allowed;
      if (!is_believed || there <= best) continue;
      best = there;
      best_angle = angle;
    }
  }
  // The estimate may be what is contradicted; but a finger makes a fine handle, too.
  if (best > now + kContradictedNat) {
    best = std::max(now, best + outlineEvidence(likelihood, at(best_angle), estimate));
  }
  look.is_contradicted = best > now + kContradictedNat;
  weigh(best, axis.belief);
  return look;
}

void FreeTurn::weigh(double best, AngleBelief& belief) const {
  const auto against = [&](std::size_t step) {
    return std::clamp(best - evidence_[step % evidence_.size()] - kContradictedNat, 0.0, kMostAgainstNat);
  };
  belief.weigh([&against](double angle) {
    const double steps = angle / kStepRad, below = std::floor(steps);
    const auto k = static_cast<std::size_t>(below + AngleBelief::kSteps);
    const double share = steps - below;
    return (1.0 - share) * against(k) + share * against(k + 1);
  });
}

void FreeTurn::wait(const Pose& estimate, const Motion& motion) {
  for (Axis& axis : axes_) {
    axis.is_free = true;
    axis.rate *= std::exp2(-motion.dt_s / kRateHalfLifeS);
    axis.belief.diffuse(grownBy(motion, estimate.linear() * axis.axis.direction));
    axis.doubted *= std::exp2(-motion.dt_s / kDoubtedHalfLifeS);
  }
}

void FreeTurn::turned(const Pose& T_before_now) {
  const Eigen::Vector3d turn = logSo3(T_before_now.linear());
  for (Axis& axis : axes_) {
    const double angle = axis.axis.direction.dot(turn);
    axis.doubted = std::max(axis.doubted, kWrongShare * angle * angle);
  }
}

Vector6d FreeTurn::shownPart(const Vector6d& velocity, const Pose& T_camera_centre) const {
  Vector6d shown = velocity;
  for (const Axis& axis : axes_) {
    if (!axis.is_free) continue;
    const Eigen::Vector3d direction = T_camera_centre.linear() * axis.axis.direction;
    shown.tail<3>() += (axis.rate - direction.dot(shown.tail<3>())) * direction;
  }
  return shown;
}

double FreeTurn::varianceOf(const Axis& axis) {
  const AngleBelief::Moments moments = axis.belief.moments();
  return moments.variance + moments.mean * moments.mean;
}

Matrix6d FreeTurn::widened(const Matrix6d& covariance, const Pose& T_camera_centre) const {
  Matrix6d result = covariance;
  for (const Axis& axis : axes_) {
    const double variance = varianceOf(axis) + axis.doubted;
    if (!axis.is_free && axis.doubted < kDoubtedAbove) continue;
    Vector6d turning;  // of the centre, per radian
    turning << T_camera_centre.linear() * axis.axis.point.cross(axis.axis.direction),
        T_camera_centre.linear() * axis.axis.direction;
    const double known = turning.tail<3>().dot(result.bottomRightCorner<3, 3>() * turning.tail<3>());
    result += std::max(0.0, variance - known) * turning * turning.transpose();
  }
  return result;
}

bool FreeTurn::isFree() const {
  return std::any_of(axes_.begin(), axes_.end(), [](const Axis& axis) { return axis.is_free; });
}

double FreeTurn::stddevRad() const {
  double variance = 0.0;
  for (const Axis& axis : axes_) variance = std::max(variance, varianceOf(axis));
  return std::sqrt(variance);
}

}  // namespace depth_object_tracker
