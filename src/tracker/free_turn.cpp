// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/free_turn.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

constexpr int kStepsPerHalfTurn = 32;
constexpr double kStepRad = M_PI / kStepsPerHalfTurn;
constexpr double kContradictedNat = 3.0;
constexpr double kAnyAngleVariance = M_PI * M_PI / 3.0;
constexpr double kRegionStepRad = M_PI / 3.0;

}  // namespace

FreeTurn::FreeTurn(std::vector<ScrewAxis> axes) {
  for (const ScrewAxis& axis : axes) axes_.push_back({axis});
}

void FreeTurn::restart(double stddev_rad) {
  for (Axis& axis : axes_) {
    axis.variance = std::min(stddev_rad * stddev_rad, kAnyAngleVariance);
    axis.is_free = true;
  }
}

void FreeTurn::update(DepthLikelihood& likelihood, const Pose& T_camera_centre, double exponent,
                      double process_variance_rad2) {
  if (axes_.empty()) return;
  region_.clear();
  for (const Axis& axis : axes_) {
    for (double turn = 0.0; turn < 2.0 * M_PI; turn += kRegionStepRad) {
      region_.push_back(T_camera_centre * turnAbout(axis.axis, turn));
    }
  }
  likelihood.prepare(region_);
  const double least = likelihood.logLikelihood(T_camera_centre, 0) - kContradictedNat / exponent;
  for (Axis& axis : axes_) {
    const int back = stepsAllowed(likelihood, T_camera_centre, axis.axis, -1, least);
    const int forth = stepsAllowed(likelihood, T_camera_centre, axis.axis, 1, least);
    axis.is_free = back + forth > 0;
    // Second moment about the estimate of an angle that is anywhere in between.
    const double from = -(back + 0.5) * kStepRad, to = (forth + 0.5) * kStepRad;
    axis.variance =
        std::min(axis.variance + process_variance_rad2, (to * to * to - from * from * from) / (3.0 * (to - from)));
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
    if (!axis.is_free) continue;
    Vector6d turning;  // of the centre, per radian
    turning << T_camera_centre.linear() * axis.axis.point.cross(axis.axis.direction),
        T_camera_centre.linear() * axis.axis.direction;
    const double known = turning.tail<3>().dot(result.bottomRightCorner<3, 3>() * turning.tail<3>());
    result += std::max(0.0, axis.variance - known) * turning * turning.transpose();
  }
  return result;
}

double FreeTurn::stddevRad() const {
  double variance = 0.0;
  for (const Axis& axis : axes_) variance = std::max(variance, axis.variance);
  return std::sqrt(variance);
}

}  // namespace depth_object_tracker
