// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/convex_hull.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <set>
#include <utility>

namespace depth_object_tracker {
namespace {

HullFace makeFace(const std::vector<Eigen::Vector3d>& points, int a, int b, int c) {
  const auto at = [&](int index) { return points[static_cast<std::size_t>(index)]; };
  return {{a, b, c}, (at(b) - at(a)).cross(at(c) - at(a)).normalized()};
}

template <typename Value>
int indexOfLargest(const std::vector<Eigen::Vector3d>& points, const Value& value) {
  int best = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (value(points[i]) > value(points[static_cast<std::size_t>(best)])) best = static_cast<int>(i);
  }
  return best;
}

/// A tetrahedron of far points.
std::vector<HullFace> firstFaces(const std::vector<Eigen::Vector3d>& points) {
  const auto at = [&](int index) { return points[static_cast<std::size_t>(index)]; };
  const int a = indexOfLargest(points, [](const Eigen::Vector3d& p) { return -p.x(); });
  const int b = indexOfLargest(points, [&](const Eigen::Vector3d& p) { return (p - at(a)).squaredNorm(); });
  const Eigen::Vector3d along = (at(b) - at(a)).normalized();
  const int c = indexOfLargest(points, [&](const Eigen::Vector3d& p) { return (p - at(a)).cross(along).norm(); });
  const Eigen::Vector3d normal = (at(b) - at(a)).cross(at(c) - at(a)).normalized();
  const int d = indexOfLargest(points, [&](const Eigen::Vector3d& p) { return std::abs(normal.dot(p - at(a))); });
  const double height = normal.dot(at(d) - at(a));
  if (height < 0.0) {
    return {makeFace(points, a, b, c), makeFace(points, a, c, d), makeFace(points, c, b, d), makeFace(points, b, a, d)};
  }
  return {makeFace(points, a, c, b), makeFace(points, a, b, d), makeFace(points, b, c, d), makeFace(points, c, a, d)};
}

/// Replaces the faces that see the point by a cone from their rim to it.
void addPoint(const std::vector<Eigen::Vector3d>& points, int index, std::vector<HullFace>& faces) {
  const Eigen::Vector3d& point = points[static_cast<std::size_t>(index)];
  const auto sees = [&](const HullFace& face) {
    return face.normal.dot(point - points[static_cast<std::size_t>(face.corners[0])]) > 0.0;
  };
  std::set<std::pair<int, int>> edges;  // of the faces that go, with their direction
  for (const HullFace& face : faces) {
    if (!sees(face)) continue;
    for (std::size_t k = 0; k < 3; ++k) edges.emplace(face.corners[k], face.corners[(k + 1) % 3]);
  }
  if (edges.empty()) return;
  faces.erase(std::remove_if(faces.begin(), faces.end(), sees), faces.end());
  for (const auto& [from, to] : edges) {
    if (edges.count({to, from}) == 0) faces.push_back(makeFace(points, from, to, index));
  }
}

}  // namespace

std::vector<HullFace> convexHull(const std::vector<Eigen::Vector3d>& points) {
  if (points.size() < 4) return {};
  std::vector<HullFace> faces = firstFaces(points);
  std::set<int> used;  // corners see their own faces by rounding
  for (const HullFace& face : faces) used.insert(face.corners.begin(), face.corners.end());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (used.count(static_cast<int>(i)) == 0) addPoint(points, static_cast<int>(i), faces);
  }
  return faces;
}

}  // namespace depth_object_tracker
