// SPDX-License-Identifier: BSD-3-Clause
// Pairs of oriented points of an object, found by how they lie to one another: a pair of the image that lies likewise
// fixes the object's pose (Drost, Ulrich, Navab and Ilic, CVPR 2010).
#pragma once

#include "depth_object_tracker/tracker/oriented_points.h"

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace depth_object_tracker {

/// Distance of two points and three angles between their normals and the line from one to the other.
struct PairFeature {
  double distance_m, first_rad, second_rad, normals_rad;
};
PairFeature pairFeature(const OrientedPoint& first, const OrientedPoint& second);

class PointPairs {
 public:
  /// @param points of the object, from its centre, object axes. @param diameter_m of the object.
  PointPairs(const std::vector<OrientedPoint>& points, double diameter_m);

  /// Distances between which pairs are told apart [m].
  double leastDistanceM() const { return least_m_; }
  double mostDistanceM() const { return most_m_; }

  /// T_camera_centre that lays a pair of the object like this one on it; nullopt when there is none.
  /// @param jitter four numbers in [0, 1) that choose between neighbouring cells of features, @param choice in [0, 1)
  /// between the pairs alike.
  std::optional<Pose> layOn(const OrientedPoint& first, const OrientedPoint& second,
                            const std::array<double, 4>& jitter, double choice) const;

  /// Pair of the object, as one point that the other lies around.
  struct Entry {
    std::uint32_t cell;
    std::uint16_t first, second;
    float turn_rad;  ///< of the second about the first's normal, see turnAbout()
  };

  /// Pairs of the object that lie like this one: [first, last); empty when there is none. @param jitter as in layOn().
  std::pair<const Entry*, const Entry*> alike(const OrientedPoint& first, const OrientedPoint& second,
                                              const std::array<double, 4>& jitter) const;

  /// Points that the entries speak of.
  const std::vector<OrientedPoint>& points() const { return points_; }

 private:
  std::uint32_t cellOf(const PairFeature& feature, const std::array<double, 4>& jitter) const;

  std::vector<OrientedPoint> points_;
  double least_m_, most_m_, distance_step_m_;
  std::vector<Entry> entries_;        // by cell
  std::vector<std::uint32_t> start_;  // of each cell in entries_; one more at the end
};

/// Axes of a point: its normal and two directions across it that depend on nothing else.
Eigen::Matrix3d axesOf(const OrientedPoint& point);

/// Angle about a point's normal at which another lies, in the point's axes, [-pi, pi].
double turnAbout(const Eigen::Matrix3d& axes, const OrientedPoint& point, const OrientedPoint& other);

}  // namespace depth_object_tracker
