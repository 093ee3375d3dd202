// SPDX-License-Identifier: BSD-3-Clause
// Joint positions over time that take a hand along a wished path.
#pragma once

#include <Eigen/Core>

#include <functional>
#include <optional>
#include <vector>

namespace depth_object_tracker {

/// Cubic through knots, made as time goes on. Not thread-safe.
class JointTrajectory {
 public:
  /// @param next joint positions at a time, near the given ones; nullopt when there are none.
  using Solver = std::function<std::optional<Eigen::VectorXd>(double t_s, const Eigen::VectorXd& near)>;

  JointTrajectory(Solver solver, Eigen::VectorXd start);

  /// Where the path cannot be followed the joints stay as they were. @param t_s >= 0
  Eigen::VectorXd positions(double t_s);

  /// Knots that could not be reached so far.
  int numUnreached() const { return num_unreached_; }

 private:
  static constexpr double kKnotS = 0.05;
  const Eigen::VectorXd& knot(long index);

  Solver solver_;
  std::vector<Eigen::VectorXd> knots_;
  int num_unreached_ = 0;
};

}  // namespace depth_object_tracker
