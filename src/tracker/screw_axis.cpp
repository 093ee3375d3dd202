// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/screw_axis.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace depth_object_tracker {

ScrewAxis axisOf(const Pose& T) {
  const Eigen::Vector3d direction = Eigen::AngleAxisd(T.linear()).axis();
  const Eigen::Matrix3d moved = Eigen::Matrix3d::Identity() - T.linear() + direction * direction.transpose();
  const Eigen::Vector3d across = T.translation() - direction.dot(T.translation()) * direction;
  return {direction, moved.fullPivLu().solve(across)};
}

Pose turnAbout(const ScrewAxis& axis, double angle_rad) {
  return Eigen::Translation3d(axis.point) * Eigen::AngleAxisd(angle_rad, axis.direction) *
         Eigen::Translation3d(-axis.point);
}

bool isSame(const ScrewAxis& a, const ScrewAxis& b) {
  constexpr double kSameAxisCosine = 0.97;
  return std::abs(a.direction.dot(b.direction)) > kSameAxisCosine;
}

namespace {

/// Of lines in about the same direction.
ScrewAxis meanOf(const std::vector<ScrewAxis>& axes) {
  ScrewAxis mean{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  for (const ScrewAxis& axis : axes) {
    const double way = axis.direction.dot(axes.front().direction) < 0.0 ? -1.0 : 1.0;
    mean.direction += way * axis.direction;
    const Eigen::Vector3d nearest = axis.point - axis.direction.dot(axis.point) * axis.direction;  // to the origin
    mean.point += nearest / static_cast<double>(axes.size());
  }
  mean.direction.normalize();
  return mean;
}

}  // namespace

std::vector<ScrewAxis> commonAxes(const std::vector<Pose>& motions) {
  constexpr std::size_t kLeastMotions = 4;
  std::vector<ScrewAxis> axes;
  for (const Pose& T : motions) {
    const ScrewAxis axis = axisOf(T);
    const bool is_known =
        std::any_of(axes.begin(), axes.end(), [&](const ScrewAxis& other) { return isSame(other, axis); });
    if (is_known) continue;
    std::vector<ScrewAxis> alike;
    for (const Pose& other : motions) {
      if (isSame(axisOf(other), axis)) alike.push_back(axisOf(other));
    }
    if (alike.size() >= kLeastMotions) axes.push_back(meanOf(alike));
  }
  return axes;
}

}  // namespace depth_object_tracker
