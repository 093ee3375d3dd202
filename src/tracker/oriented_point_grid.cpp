// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/oriented_point_grid.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {

OrientedPointGrid::OrientedPointGrid(std::vector<OrientedPoint> points, double reach_m)
    : points_(std::move(points)), reach_m_(reach_m), cell_m_(reach_m) {
  if (!points_.empty()) {
    Eigen::Vector3d least = points_.front().point, most = least;
    for (const OrientedPoint& point : points_) {
      least = least.cwiseMin(point.point);
      most = most.cwiseMax(point.point);
    }
    corner_ = least;
    cell_m_ = std::max(reach_m, (most - least).maxCoeff() / (kMostCells - 1));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      cells_[axis] = 1 + static_cast<int>((most - least)[static_cast<Eigen::Index>(axis)] / cell_m_);
    }
  }
  // Counting sort: the end of each cell first, then each point moves its cell's start down.
  starts_.assign(index(0, 0, cells_[2]) + 1, 0);
  std::vector<std::size_t> cell_of;
  for (const OrientedPoint& point : points_) {
    const std::array<int, 3> cell = cellAt(point.point);
    cell_of.push_back(index(cell[0], cell[1], cell[2]));
    ++starts_[cell_of.back()];
  }
  for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
  order_.resize(points_.size());
  for (std::size_t i = points_.size(); i-- > 0;) order_[--starts_[cell_of[i]]] = static_cast<std::uint32_t>(i);
}

std::array<int, 3> OrientedPointGrid::cellAt(const Eigen::Vector3d& point) const {
  std::array<int, 3> cell;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // Far beyond the grid every cell is as good, and no number too large for an int.
    const auto i = static_cast<Eigen::Index>(axis);
    const double steps = std::floor((point[i] - corner_[i]) / cell_m_);
    cell[axis] = static_cast<int>(std::clamp(steps, -2.0, cells_[axis] + 1.0));
  }
  return cell;
}

std::size_t OrientedPointGrid::index(int x, int y, int z) const {
  return (static_cast<std::size_t>(z) * static_cast<std::size_t>(cells_[1]) + static_cast<std::size_t>(y)) *
             static_cast<std::size_t>(cells_[0]) +
         static_cast<std::size_t>(x);
}

const OrientedPoint* OrientedPointGrid::nearest(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                                                double least_cosine) const {
  const std::array<int, 3> cell = cellAt(point);
  const int x_begin = std::max(0, cell[0] - 1), x_end = std::min(cells_[0], cell[0] + 2);
  const OrientedPoint* best = nullptr;
  double least = reach_m_ * reach_m_;
  if (x_begin >= x_end) return best;
  for (int z = std::max(0, cell[2] - 1); z < std::min(cells_[2], cell[2] + 2); ++z) {
    for (int y = std::max(0, cell[1] - 1); y < std::min(cells_[1], cell[1] + 2); ++y) {
      // Cells along x lie one after the other.
      const std::uint32_t end = starts_[index(x_end - 1, y, z) + 1];
      for (std::uint32_t i = starts_[index(x_begin, y, z)]; i < end; ++i) {
        const OrientedPoint& other = points_[order_[i]];
        const double squared = (other.point - point).squaredNorm();
        const bool is_nearer = squared < least || (squared == least && best != nullptr && &other < best);
        if (!is_nearer || std::abs(other.normal.dot(normal)) < least_cosine) continue;
        least = squared;
        best = &other;
      }
    }
  }
  return best;
}

}  // namespace depth_object_tracker
