// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/geometry/stable_poses.h"

#include "geometry/convex_hull.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <utility>

namespace depth_object_tracker {
namespace {

/// The vertices that are outermost in many directions, from the centre.
std::vector<Eigen::Vector3d> outermostPoints(const TriangleMesh& mesh, const Eigen::Vector3d& centre_object) {
  constexpr int kDirections = 700;
  const double golden_angle = M_PI * (3.0 - std::sqrt(5.0));
  std::vector<std::size_t> chosen;
  for (int k = 0; k < kDirections; ++k) {
    const double z = 1.0 - 2.0 * (k + 0.5) / kDirections, radius = std::sqrt(1.0 - z * z);
    const Eigen::Vector3f direction(static_cast<float>(radius * std::cos(k * golden_angle)),
                                    static_cast<float>(radius * std::sin(k * golden_angle)), static_cast<float>(z));
    const auto farthest =
        std::max_element(mesh.vertices.begin(), mesh.vertices.end(),
                         [&](const auto& a, const auto& b) { return a.dot(direction) < b.dot(direction); });
    chosen.push_back(static_cast<std::size_t>(farthest - mesh.vertices.begin()));
  }
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  // Moved by next to nothing, no four of them lie in a plane and no three on a line: the hull needs no special cases.
  constexpr double kMovedPerDiameter = 2e-5;
  const double moved_m = kMovedPerDiameter * diameter(mesh);
  std::mt19937 bits(1);
  std::vector<Eigen::Vector3d> points;
  for (const std::size_t index : chosen) {
    Eigen::Vector3d displacement;
    for (int axis = 0; axis < 3; ++axis)
      displacement[axis] = moved_m * (static_cast<double>(bits()) / std::mt19937::max() - 0.5);
    points.push_back(mesh.vertices[index].cast<double>() - centre_object + displacement);
  }
  return points;
}

/// Solid angle of a triangle seen from the origin (Van Oosterom and Strackee, 1983).
double solidAngle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const double volume = std::abs(a.dot(b.cross(c)));
  const double base = a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() + b.dot(c) * a.norm() + c.dot(a) * b.norm();
  return 2.0 * std::abs(std::atan2(volume, base));
}

bool isFlat(const TriangleMesh& mesh) {
  constexpr double kLeastThicknessPerDiameter = 1e-3;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    mean += vertex.cast<double>();
    scatter += vertex.cast<double>() * vertex.cast<double>().transpose();
  }
  const auto count = static_cast<double>(mesh.vertices.size());
  mean /= count;
  scatter = scatter / count - mean * mean.transpose();
  const double variance = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvalues()[0];
  return variance < std::pow(kLeastThicknessPerDiameter * diameter(mesh), 2.0);
}

/// Hull whose faces know over which edge the object tips.
class TippingHull {
 public:
  explicit TippingHull(const std::vector<Eigen::Vector3d>& points) : points_(points), faces_(convexHull(points)) {
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      for (std::size_t k = 0; k < 3; ++k) face_of_edge_[{corner(f, k), corner(f, k + 1)}] = f;
    }
  }

  std::size_t size() const { return faces_.size(); }
  const Eigen::Vector3d& normal(std::size_t face) const { return faces_[face].normal; }
  double height(std::size_t face) const { return normal(face).dot(at(corner(face, 0))); }
  double share(std::size_t face) const {
    return solidAngle(at(corner(face, 0)), at(corner(face, 1)), at(corner(face, 2))) / (4.0 * M_PI);
  }

  /// The face on which the object comes to rest from this one: it tips over the edge that the centre is farthest
  /// beyond, and its height falls with each.
  std::size_t restingFace(std::size_t face) const {
    for (std::size_t step = 0; step < faces_.size(); ++step) {
      double farthest = 0.0;
      std::size_t next = face;
      for (std::size_t k = 0; k < 3; ++k) {
        const Eigen::Vector3d& from = at(corner(face, k));
        const Eigen::Vector3d along = (at(corner(face, k + 1)) - from).normalized();
        const double beyond = -normal(face).cross(along).dot(-from);  // of the centre, which is the origin
        const auto other = face_of_edge_.find({corner(face, k + 1), corner(face, k)});
        if (beyond > farthest && other != face_of_edge_.end()) {
          farthest = beyond;
          next = other->second;
        }
      }
      if (next == face) break;
      face = next;
    }
    return face;
  }

 private:
  int corner(std::size_t face, std::size_t k) const { return faces_[face].corners[k % 3]; }
  const Eigen::Vector3d& at(int index) const { return points_[static_cast<std::size_t>(index)]; }

  std::vector<Eigen::Vector3d> points_;
  std::vector<HullFace> faces_;
  std::map<std::pair<int, int>, std::size_t> face_of_edge_;
};

}  // namespace

std::vector<StablePose> stablePoses(const TriangleMesh& mesh, const Eigen::Vector3d& centre_object) {
  if (isFlat(mesh)) return {};
  const TippingHull hull(outermostPoints(mesh, centre_object));
  std::map<std::size_t, double> probabilities;
  double sum = 0.0;
  for (std::size_t face = 0; face < hull.size(); ++face) {
    probabilities[hull.restingFace(face)] += hull.share(face);
    sum += hull.share(face);
  }
  std::vector<StablePose> poses;
  poses.reserve(probabilities.size());
  for (const auto& [face, probability] : probabilities) {
    poses.push_back({-hull.normal(face), hull.height(face), probability / sum});
  }
  std::stable_sort(poses.begin(), poses.end(),
                   [](const StablePose& a, const StablePose& b) { return a.probability > b.probability; });
  return poses;
}

}  // namespace depth_object_tracker
