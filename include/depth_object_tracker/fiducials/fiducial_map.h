// SPDX-License-Identifier: BSD-3-Clause
// Which AprilTags an object carries, and where.
#pragma once

#include "depth_object_tracker/geometry/pose.h"

#include <array>
#include <string>
#include <vector>

namespace depth_object_tracker {

/// One tag. Its frame: origin in the middle, x right and y down as one looks at the printed side, z into the object.
struct Fiducial {
  int id = 0;
  double size_m = 0.03;  ///< edge of the black square, without the white margin around it
  Pose T_object_tag = Pose::Identity();

  /// Corners of the black square in the object frame: bottom left, bottom right, top right, top left.
  std::array<Eigen::Vector3d, 4> corners() const;
};

struct FiducialMap {
  std::string family = "tag36h11";
  std::vector<Fiducial> tags;

  /// nullptr when the object carries no such tag.
  const Fiducial* find(int id) const;

  /// Mean of the tags' places [m], object frame.
  Eigen::Vector3d centre() const;
};

/// Reads `family, tags: [{id, size_m, position: [3], orientation: [qx, qy, qz, qw]}]`, metres, object frame.
/// @throws std::invalid_argument naming file, key and what is wrong; unknown keys and repeated ids are errors.
FiducialMap loadFiducialMap(const std::string& yaml_file);

/// The same file written. @throws std::runtime_error when it cannot be.
void saveFiducialMap(const FiducialMap& map, const std::string& yaml_file);

}  // namespace depth_object_tracker
