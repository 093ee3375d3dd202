// SPDX-License-Identifier: BSD-3-Clause
// Ear clipping.
#include "polygon_triangulation.h"

#include <Eigen/Geometry>

#include <numeric>

namespace depth_object_tracker {
namespace {

using Loop = std::vector<std::size_t>;

/// Corners in the plane across their mean normal (Newell), running counter-clockwise.
std::vector<Eigen::Vector2d> flatten(const std::vector<Eigen::Vector3d>& corners) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    normal += (corners[i] - corners[0]).cross(corners[(i + 1) % corners.size()] - corners[0]);
  }
  if (normal.norm() > 0.0) normal.normalize();
  const Eigen::Vector3d u = normal.norm() > 0.0 ? normal.unitOrthogonal() : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d v = normal.norm() > 0.0 ? normal.cross(u) : Eigen::Vector3d::UnitY();
  std::vector<Eigen::Vector2d> flat;
  flat.reserve(corners.size());
  for (const Eigen::Vector3d& corner : corners)
    flat.emplace_back(u.dot(corner - corners[0]), v.dot(corner - corners[0]));
  return flat;
}

double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

/// True when the corner at `position` of the loop is convex and no other corner lies in the triangle that it would cut
/// off.
bool isEar(const Loop& loop, std::size_t position, const std::vector<Eigen::Vector2d>& flat) {
  const Eigen::Vector2d& a = flat[loop[(position + loop.size() - 1) % loop.size()]];
  const Eigen::Vector2d& b = flat[loop[position]];
  const Eigen::Vector2d& c = flat[loop[(position + 1) % loop.size()]];
  if (turn(a, b, c) <= 0.0) return false;
  for (const std::size_t index : loop) {
    const Eigen::Vector2d& p = flat[index];
    if (p == a || p == b || p == c) continue;
    if (turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0) return false;
  }
  return true;
}

}  // namespace

std::vector<std::array<std::size_t, 3>> triangulatePolygon(const std::vector<Eigen::Vector3d>& corners) {
  std::vector<std::array<std::size_t, 3>> triangles;
  if (corners.size() < 3) return triangles;
  const std::vector<Eigen::Vector2d> flat = flatten(corners);
  Loop loop(corners.size());
  std::iota(loop.begin(), loop.end(), std::size_t{0});
  std::size_t position = 1;
  while (loop.size() > 3) {
    // Going on behind the last ear spreads the cuts instead of making a fan. Without any ear (a crossing or flat loop)
    // cut anyway.
    std::size_t tries = 0;
    while (tries < loop.size() && !isEar(loop, position % loop.size(), flat)) ++position, ++tries;
    position %= loop.size();
    triangles.push_back(
        {loop[(position + loop.size() - 1) % loop.size()], loop[position], loop[(position + 1) % loop.size()]});
    loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(position));
    ++position;
  }
  triangles.push_back({loop[0], loop[1], loop[2]});
  return triangles;
}

}  // namespace depth_object_tracker
