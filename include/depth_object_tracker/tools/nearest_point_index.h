// SPDX-License-Identifier: BSD-3-Clause
// k-d tree over a fixed set of points.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace depth_object_tracker {

class NearestPointIndex {
 public:
  /// @param points [m], at least one, finite.
  explicit NearestPointIndex(std::vector<Eigen::Vector3f> points);

  /// Distance from `query` to the nearest point [m].
  float distance(const Eigen::Vector3f& query) const;

 private:
  void build(std::size_t begin, std::size_t end);
  void search(std::size_t begin, std::size_t end, const Eigen::Vector3f& query, float& best_squared) const;

  std::vector<Eigen::Vector3f> points_;   // every range's median stands in its middle
  std::vector<std::uint8_t> split_axis_;  // of the range whose median stands here
};

}  // namespace depth_object_tracker
