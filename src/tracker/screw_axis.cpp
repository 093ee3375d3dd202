// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/screw_axis.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

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

std::vector<ScrewAxis> commonAxes(const std::vector<Pose>& motions) {
  constexpr std::ptrdiff_t kLeastMotions = 4;
  std::vector<ScrewAxis> axes;
  for (const Pose& T : motions) {
    const ScrewAxis axis = axisOf(T);
    const auto alike =
        std::count_if(motions.begin(), motions.end(), [&](const Pose& other) { return isSame(axisOf(other), axis); });
    const bool is_known =
        std::any_of(axes.begin(), axes.end(), [&](const ScrewAxis& other) { return isSame(other, axis); });
    if (alike >= kLeastMotions && !is_known) axes.push_back(axis);
  }
  return axes;
}

}  // namespace depth_object_tracker
