// SPDX-License-Identifier: BSD-3-Clause
// The nearest of many points of a surface, without looking at all of them.
#pragma once

#include "depth_object_tracker/tracker/oriented_points.h"

#include <array>
#include <cstdint>
#include <vector>

namespace depth_object_tracker {

/// Points in cells as wide as the farthest that is asked for: what is near lies in a cell or in one beside it.
class OrientedPointGrid {
 public:
  /// @param points finite, in one frame; may be empty. @param reach_m [m] > 0 where there are points.
  OrientedPointGrid(std::vector<OrientedPoint> points, double reach_m);

  /// @param point finite, in the frame of the points [m]. @param normal unit length. @param least_cosine between the
  /// normals, whichever way they point: meshes may be wound either way.
  /// @return the nearest of those within the reach whose normal is like that, of equally near ones the first; null if
  /// there is none.
  const OrientedPoint* nearest(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double least_cosine) const;

  const std::vector<OrientedPoint>& points() const { return points_; }

 private:
  static constexpr int kMostCells = 64;  // along an axis: wider cells do as well

  std::array<int, 3> cellAt(const Eigen::Vector3d& point) const;
  std::size_t index(int x, int y, int z) const;

  std::vector<OrientedPoint> points_;
  double reach_m_, cell_m_;
  Eigen::Vector3d corner_ = Eigen::Vector3d::Zero();
  std::array<int, 3> cells_ = {1, 1, 1};
  std::vector<std::uint32_t> order_;   // points_ by cell, in each as they came
  std::vector<std::uint32_t> starts_;  // of each cell in order_, and the end
};

}  // namespace depth_object_tracker
