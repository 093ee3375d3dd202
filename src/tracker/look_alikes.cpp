// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/look_alikes.h"

#include "depth_object_tracker/tracker/oriented_point_grid.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace depth_object_tracker {
namespace {

constexpr std::size_t kRotations = 1500;  // looked at: some 20 degrees apart
constexpr std::size_t kMaxLookAlikes = 32;
constexpr std::size_t kSurfacePoints = 2000, kFewPoints = 60, kManyPoints = 250;
constexpr double kReachPerDiameter = 0.08;      // to the nearest of the surface's points
constexpr double kTolerancePerDiameter = 0.03;  // off the surface
constexpr double kLeastOverlapAtFirst = 0.45, kLeastOverlap = 0.7;
constexpr double kSameNormalCosine = 0.7;
constexpr int kAlignments = 6;

using Triangle = std::array<std::uint32_t, 3>;

/// Points spread evenly over the surface.
std::vector<OrientedPoint> surfacePoints(const TriangleMesh& mesh, const Eigen::Vector3d& centre) {
  const auto corner = [&](const Triangle& triangle, int k) -> Eigen::Vector3d {
    return mesh.vertices[static_cast<std::size_t>(triangle[static_cast<std::size_t>(k)])].cast<double>() - centre;
  };
  const auto double_area = [&](const Triangle& t) -> Eigen::Vector3d {
    return (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0));
  };
  double area = 0.0;
  for (const Triangle& triangle : mesh.triangles) area += double_area(triangle).norm();
  std::vector<OrientedPoint> points;
  double passed = 0.0;
  for (const Triangle& triangle : mesh.triangles) {
    const Eigen::Vector3d normal = double_area(triangle);
    passed += normal.norm() / area * static_cast<double>(kSurfacePoints);
    while (static_cast<double>(points.size()) + 0.5 < passed) {
      // Additive recurrence, folded into the triangle.
      const double n = static_cast<double>(points.size());
      double u = n * 0.7548776662466927, v = n * 0.5698402909980532;
      u -= std::floor(u);
      v -= std::floor(v);
      if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
      }
      const Eigen::Vector3d origin = corner(triangle, 0);
      points.push_back(
          {origin + u * (corner(triangle, 1) - origin) + v * (corner(triangle, 2) - origin), normal.normalized()});
    }
  }
  return points;
}

/// How an object lies on itself when it is moved.
struct Overlap {
  double share = 0.0;              ///< of its surface that lies on its surface
  Pose better = Pose::Identity();  ///< lays the parts that do on one another better
};

/// @param queries points of the surface that are looked at.
Overlap overlapAt(const OrientedPointGrid& surface, std::size_t queries, const Pose& T, double diameter_m) {
  Overlap result;
  result.better = T;
  Matrix6d information = 1e-6 * Matrix6d::Identity();
  Vector6d gradient = Vector6d::Zero();
  const std::vector<OrientedPoint>& points = surface.points();
  const std::size_t count = std::min(queries, points.size());
  for (std::size_t i = 0; i < count; ++i) {
    const OrientedPoint& point = points[i * points.size() / count];
    const Eigen::Vector3d moved = T * point.point;
    const OrientedPoint* other = surface.nearest(moved, T.linear() * point.normal, kSameNormalCosine);
    if (other == nullptr) continue;
    const double off = other->normal.dot(other->point - moved);
    result.share += std::abs(off) < kTolerancePerDiameter * diameter_m ? 1.0 / static_cast<double>(count) : 0.0;
    Vector6d jacobian;
    jacobian << other->normal, (moved - T.translation()).cross(other->normal);
    information += jacobian * jacobian.transpose();
    gradient += off * jacobian;
  }
  information.diagonal().tail<3>().array() += 1e-3 * diameter_m * diameter_m;
  information.diagonal().head<3>().array() += 1e-3;
  result.better = perturb(T, information.ldlt().solve(gradient));
  return result;
}

bool isNearAny(const Pose& T, const std::vector<Pose>& others, const Symmetries& symmetries) {
  const auto near = [&](const Pose& other) {
    return rotationAngle(foldOntoReference(T, other, symmetries).linear().transpose() * other.linear()) <
           kLookAlikesApartRad;
  };
  return near(Pose::Identity()) || std::any_of(others.begin(), others.end(), near);
}

/// Turns about the axis all the way instead of those that happened to be found.
void spaceEvenly(const ScrewAxis& axis, std::vector<Pose>& turns) {
  constexpr int kTurns = 20;
  turns.erase(std::remove_if(turns.begin(), turns.end(), [&](const Pose& T) { return isSame(axisOf(T), axis); }),
              turns.end());
  for (int k = 1; k < kTurns; ++k) turns.push_back(turnAbout(axis, 2.0 * M_PI * k / kTurns));
}

}  // namespace

LookAlikes findLookAlikes(const TriangleMesh& mesh, const Eigen::Vector3d& centre_object,
                          const Symmetries& symmetries) {
  const double diameter_m = diameter(mesh);
  const OrientedPointGrid surface(surfacePoints(mesh, centre_object), kReachPerDiameter * diameter_m);
  std::vector<std::pair<double, Pose>> found;
  for (std::size_t k = 0; k < kRotations && !surface.points().empty(); ++k) {
    Pose T = Pose::Identity();
    T.linear() = evenlySpreadRotation(k);
    Overlap overlap = overlapAt(surface, kFewPoints, T, diameter_m);
    if (overlap.share < kLeastOverlapAtFirst) continue;
    for (int i = 0; i < kAlignments; ++i) overlap = overlapAt(surface, kFewPoints, overlap.better, diameter_m);
    const double share = overlapAt(surface, kManyPoints, overlap.better, diameter_m).share;
    if (share >= kLeastOverlap) found.emplace_back(share, overlap.better);
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  LookAlikes look_alikes;
  for (const auto& [share, T] : found) {
    if (look_alikes.far.size() < kMaxLookAlikes && !isNearAny(T, look_alikes.far, symmetries)) {
      look_alikes.far.push_back(T);
    }
  }
  look_alikes.axes = commonAxes(look_alikes.far);
  for (const ScrewAxis& axis : look_alikes.axes) spaceEvenly(axis, look_alikes.far);
  return look_alikes;
}

}  // namespace depth_object_tracker
