// SPDX-License-Identifier: BSD-3-Clause
// Lines that an object can turn about and look almost the same all the way, such as a mug's.
#pragma once

#include "depth_object_tracker/geometry/pose.h"

#include <vector>

namespace depth_object_tracker {

struct ScrewAxis {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit length
  Eigen::Vector3d point = Eigen::Vector3d::Zero();       ///< [m], any on the line
};

/// The line that a motion turns about. @param T that turns by more than nothing.
ScrewAxis axisOf(const Pose& T);

/// The motion that turns about the line by an angle [rad].
Pose turnAbout(const ScrewAxis& axis, double angle_rad);

/// About the same direction, either way.
bool isSame(const ScrewAxis& a, const ScrewAxis& b);

/// Axes that several of the motions turn about: those of a mug's look-alikes, not of a box's.
std::vector<ScrewAxis> commonAxes(const std::vector<Pose>& motions);

}  // namespace depth_object_tracker
