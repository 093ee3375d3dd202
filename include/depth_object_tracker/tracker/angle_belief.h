// SPDX-License-Identifier: BSD-3-Clause
// What is believed of an angle, by steps over the whole circle.
#pragma once

#include <algorithm>
#include <array>
#include <functional>

namespace depth_object_tracker {

/// Density of the true angle about an estimate's, which may turn.
class AngleBelief {
 public:
  static constexpr int kSteps = 64;

  struct Moments {
    double mean = 0.0;      ///< [rad], from the estimate; 0 where no direction is likelier than others
    double variance = 0.0;  ///< [rad^2], about the mean
  };

  AngleBelief() { restart(0.0); }

  /// @param stddev_rad about the estimate; infinite = any angle.
  void restart(double stddev_rad);

  /// @param angle_rad by which the estimate has turned farther than what is believed.
  void turnEstimate(double angle_rad);

  /// @param variance [rad^2] by which the angle may have changed.
  void diffuse(double variance);

  /// @param against [nat] evidence against an angle from the estimate, in [-pi, pi).
  void weigh(const std::function<double(double)>& against);

  /// @return share of what is believed near an angle [rad] from the estimate.
  double near(double angle_rad) const;

  /// @return of the likeliest angle what near() returns.
  double peak() const { return *std::max_element(share_.begin(), share_.end()); }

  Moments moments() const;

 private:
  double angleOf(int step) const;
  void normalise();

  std::array<double, kSteps> share_;
  double estimate_rad_ = 0.0;  // angle of the estimate among the steps
};

/// @return the same angle in [-pi, pi).
double wrappedAngle(double angle_rad);

}  // namespace depth_object_tracker
