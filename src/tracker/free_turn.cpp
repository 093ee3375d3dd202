// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/free_turn.h"

#include "depth_object_tracker/geometry/pose.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

constexpr int kStepsPerHalfTurn = 32;
constexpr double kStepRad = M_PI / kStepsPerHalfTurn;
constexpr double kContradictedNat = 3.0;
constexpr double kAnyAngleVariance = M_PI * M_PI / 3.0;
constexpr double kRegionStepRad = M_PI / 3.0;

constexpr int kLeastStepsToTurn = 8;
constexpr double kLeastTurnRad = 0.005;
constexpr double kDoubtedAbove = 1e-4;  // [rad^2]
constexpr double kShownHalfLifeS = 0.1;
constexpr double kWrongShare = 0.1, kDoubtedHalfLifeS = 1.0;  // of turns to what looks alike

struct AngleMoments {
  double mean, variance;
};

/// Of a normal angle that is known to lie in an interval.
AngleMoments truncatedNormal(double mean, double variance, double from, double to) {
  constexpr int kPoints = 64;
  double sum = 0.0, first = 0.0, second = 0.0;
  for (int k = 0; k < kPoints; ++k) {
    const double angle = from + (to - from) * (k + 0.5) / kPoints;
    const double weight = std::exp(-0.5 * (angle - mean) * (angle - mean) / variance);
    sum += weight;
    first += weight * angle;
    second += weight * angle * angle;
  }
  if (!(sum > 1e-12)) return {std::clamp(mean, from, to), variance};
  return {first / sum, std::max(second / sum - first * first / (sum * sum), 1e-6)};
}

/// Of an angle that is anywhere in between.
double squaredMean(double from, double to) {
  return (to * to * to - from * from * from) / (3.0 * (to - from));
}

/// An object turns about the axis that is not shown as fast as it does about the others, for a while one way.
double grownBy(const FreeTurn::Motion& motion, const Eigen::Vector3d& axis_in_camera) {
  constexpr double kOneWayS = 0.15;
  const double across = motion.angular_velocity.cross(axis_in_camera).squaredNorm() / 2.0;
  return motion.process_variance_rad2 + 2.0 * kOneWayS * motion.dt_s * across;
}

}  // namespace

FreeTurn::FreeTurn(const std::vector<ScrewAxis>& axes) {
  for (const ScrewAxis& axis : axes) axes_.push_back({axis});
}

void FreeTurn::restart(double stddev_rad) {
  for (Axis& axis : axes_) {
    axis.variance = std::min(stddev_rad * stddev_rad, kAnyAngleVariance);
    axis.is_free = true;
    axis.doubted = 0.0;
  }
}

std::optional<Pose> FreeTurn::update(DepthLikelihood& likelihood, const Pose& predicted, const Pose& estimate,
                                     double exponent, const Motion& motion) {
  if (axes_.empty()) return std::nullopt;
  region_.clear();
  for (const Axis& axis : axes_) {
    for (double turn = 0.0; turn < 2.0 * M_PI; turn += kRegionStepRad) {
      region_.push_back(estimate * turnAbout(axis.axis, turn));
    }
  }
  likelihood.prepare(region_);
  const double least = likelihood.logLikelihood(estimate, 0) - kContradictedNat / exponent;
  const Eigen::Vector3d surprise = logSo3(predicted.linear().transpose() * estimate.linear());
  std::optional<Pose> turn;
  for (Axis& axis : axes_) {
    const int back = stepsAllowed(likelihood, estimate, axis.axis, -1, least);
    const int forth = stepsAllowed(likelihood, estimate, axis.axis, 1, least);
    const double variance = axis.variance + grownBy(motion, estimate.linear() * axis.axis.direction);
    axis.is_free = back + forth > 0;
    axis.doubted *= std::exp2(-motion.dt_s / kDoubtedHalfLifeS);
    const bool shows_nothing = back + forth >= 2 * kStepsPerHalfTurn;  // as of a can: any turn is as good
    if (back + forth < kLeastStepsToTurn || shows_nothing) {
      const double shown = squaredMean(-(back + 0.5) * kStepRad, (forth + 0.5) * kStepRad);
      axis.variance = std::min(variance, std::max(shown, axis.variance * std::exp2(-motion.dt_s / kShownHalfLifeS)));
      continue;
    }
    const double from = -(back + 1.5) * kStepRad, to = (forth + 1.5) * kStepRad;
    const AngleMoments angle = truncatedNormal(-axis.axis.direction.dot(surprise), variance, from, to);
    axis.variance = angle.variance;
    if (std::abs(angle.mean) > kLeastTurnRad) turn = turnAbout(axis.axis, angle.mean);
  }
  return turn;
}

void FreeTurn::wait(const Pose& estimate, const Motion& motion) {
  for (Axis& axis : axes_) {
    axis.is_free = true;
    axis.variance =
        std::min(axis.variance + grownBy(motion, estimate.linear() * axis.axis.direction), kAnyAngleVariance);
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

int FreeTurn::stepsAllowed(DepthLikelihood& likelihood, const Pose& T_camera_centre, const ScrewAxis& axis, int way,
                           double least) const {
  for (int steps = 1; steps <= kStepsPerHalfTurn; ++steps) {
    const Pose turned = T_camera_centre * turnAbout(axis, way * steps * kStepRad);
    if (!(likelihood.logLikelihood(turned, 0) > least)) return steps - 1;
  }
  return kStepsPerHalfTurn;
}

Matrix6d FreeTurn::widened(const Matrix6d& covariance, const Pose& T_camera_centre) const {
  Matrix6d result = covariance;
  for (const Axis& axis : axes_) {
    const double variance = axis.variance + axis.doubted;
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
  for (const Axis& axis : axes_) variance = std::max(variance, axis.variance);
  return std::sqrt(variance);
}

}  // namespace depth_object_tracker
