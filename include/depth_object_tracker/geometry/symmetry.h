// SPDX-License-Identifier: BSD-3-Clause
// Declared symmetries of an object and the folding of equivalent poses onto one representative.
#pragma once

#include "depth_object_tracker/geometry/pose.h"

#include <optional>
#include <vector>

namespace depth_object_tracker {

/// Every rotation about this line maps the object onto itself. Object frame; `axis` has unit length.
struct SymmetryAxis {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< [m], a point on the axis
};

struct Symmetries {
  std::vector<SymmetryAxis> continuous;
  std::vector<Pose> discrete;  ///< T_object_object; the identity need not be listed
  bool empty() const { return continuous.empty() && discrete.empty(); }
};

/// The pose equivalent to `pose` whose rotation is nearest to that of `reference`.
Pose foldOntoReference(const Pose& T_camera_object, const Pose& T_camera_object_reference,
                       const Symmetries& symmetries);

/// The free axis in camera axes (unit length) when exactly one continuous symmetry is declared; two or more leave no
/// rotation observable and give nullopt as well.
std::optional<Eigen::Vector3d> freeAxisInCamera(const Pose& T_camera_object, const Symmetries& symmetries);

}  // namespace depth_object_tracker
