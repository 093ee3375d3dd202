// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/simulator/joint_trajectory.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace depth_object_tracker {

JointTrajectory::JointTrajectory(Solver solver, Eigen::VectorXd start) : solver_(std::move(solver)) {
  knots_.push_back(std::move(start));
}

const Eigen::VectorXd& JointTrajectory::knot(long index) {
  const auto wanted = static_cast<std::size_t>(std::max(index, 0L));
  while (knots_.size() <= wanted) {
    auto solved = solver_(kKnotS * static_cast<double>(knots_.size()), knots_.back());
    if (!solved) ++num_unreached_;
    knots_.push_back(solved ? std::move(*solved) : Eigen::VectorXd(knots_.back()));
  }
  return knots_[wanted];
}

Eigen::VectorXd JointTrajectory::positions(double t_s) {
  const double place = std::max(t_s, 0.0) / kKnotS;
  const long index = static_cast<long>(std::floor(place));
  const double s = place - static_cast<double>(index);
  knot(index + 2);  // makes all of them: references stay good
  const Eigen::VectorXd &a = knot(index - 1), &b = knot(index), &c = knot(index + 1), &d = knot(index + 2);
  // Catmull-Rom: continuous velocity.
  return b + 0.5 * s * (c - a + s * (2.0 * a - 5.0 * b + 4.0 * c - d + s * (3.0 * (b - c) + d - a)));
}

}  // namespace depth_object_tracker
