// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/plane_finder.h"

#include "depth_object_tracker/filter/random.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>

namespace depth_object_tracker {
namespace {

constexpr double kGridPoints = 6000.0;
constexpr int kMostPlanes = 6, kTries = 250;
constexpr double kLeastShare = 0.02;

/// Readings on a grid of pixels, still without a plane or not.
struct PointGrid {
  int rows = 0, cols = 0;
  std::vector<Eigen::Vector3d> points;  // row-major; zero without a reading
  std::vector<bool> is_free;
  int count = 0;  // readings

  std::optional<std::size_t> freeAt(int row, int col) const {
    if (row < 0 || row >= rows || col < 0 || col >= cols) return std::nullopt;
    const auto index = static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(col);
    return is_free[index] ? std::optional<std::size_t>(index) : std::nullopt;
  }
};

PointGrid makeGrid(const DepthImageView& depth, const PinholeCamera& camera, double max_depth_m) {
  const int step =
      std::max(1, static_cast<int>(std::sqrt(depth.width * static_cast<double>(depth.height) / kGridPoints)));
  PointGrid grid;
  grid.rows = depth.height / step;
  grid.cols = depth.width / step;
  for (int row = 0; row < grid.rows; ++row) {
    for (int col = 0; col < grid.cols; ++col) {
      const int r = row * step + step / 2, c = col * step + step / 2;
      const auto z = static_cast<double>(depth.at(r, c));
      const bool usable = z > 0.0 && z <= max_depth_m;  // false for NaN
      grid.points.push_back(usable ? Eigen::Vector3d(z * camera.ray(c, r)) : Eigen::Vector3d(Eigen::Vector3d::Zero()));
      grid.is_free.push_back(usable);
      grid.count += usable ? 1 : 0;
    }
  }
  return grid;
}

std::vector<std::size_t> pointsOn(const PointGrid& grid, const ImagePlane& plane, std::size_t stride) {
  std::vector<std::size_t> on;
  for (std::size_t i = 0; i < grid.points.size(); i += stride) {
    if (!grid.is_free[i]) continue;
    if (std::abs(plane.heightOf(grid.points[i])) < planeToleranceM(grid.points[i].z())) on.push_back(i);
  }
  return on;
}

ImagePlane facingTheCamera(const Eigen::Vector3d& normal, const Eigen::Vector3d& point) {
  ImagePlane plane;
  plane.normal = normal.dot(point) > 0.0 ? -normal : normal;
  plane.offset_m = plane.normal.dot(point);
  return plane;
}

/// Least squares, each reading weighted as its noise has it.
ImagePlane fitted(const PointGrid& grid, const std::vector<std::size_t>& on) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double weights = 0.0;
  const auto weight = [&](std::size_t i) { return std::pow(planeToleranceM(grid.points[i].z()), -2.0); };
  for (const std::size_t i : on) {
    mean += weight(i) * grid.points[i];
    weights += weight(i);
  }
  mean /= weights;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const std::size_t i : on) {
    scatter += weight(i) * (grid.points[i] - mean) * (grid.points[i] - mean).transpose();
  }
  return facingTheCamera(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(0), mean);
}

/// A plane through three readings that are not far from one another in the image.
std::optional<ImagePlane> drawPlane(const PointGrid& grid, const CounterRandom& random, std::uint64_t number) {
  constexpr int kReach = 14;  // grid cells
  const auto uniform = [&](std::uint32_t index) { return random.uniform(RandomPurpose::kSearch, number, index); };
  const int row = static_cast<int>(uniform(0) * grid.rows), col = static_cast<int>(uniform(1) * grid.cols);
  const auto offset = [&](std::uint32_t index) { return static_cast<int>((2.0 * uniform(index) - 1.0) * kReach); };
  const auto a = grid.freeAt(row, col), b = grid.freeAt(row + offset(2), col + offset(3)),
             c = grid.freeAt(row + offset(4), col + offset(5));
  if (!a || !b || !c) return std::nullopt;
  const Eigen::Vector3d& p = grid.points[*a];
  const Eigen::Vector3d ab = grid.points[*b] - p, ac = grid.points[*c] - p, normal = ab.cross(ac);
  constexpr double kLeastSine = 0.2;
  if (!(normal.norm() > kLeastSine * ab.norm() * ac.norm()) || normal.norm() <= 0.0) return std::nullopt;
  return facingTheCamera(normal.normalized(), p);
}

std::optional<ImagePlane> findLargest(const PointGrid& grid, const CounterRandom& random, int round) {
  constexpr std::size_t kCountEvery = 4;
  constexpr int kRefinements = 3;
  std::size_t most = 0;
  ImagePlane best;
  for (int k = 0; k < kTries; ++k) {
    const int draw = round * kTries + k;
    const auto plane = drawPlane(grid, random, static_cast<std::uint64_t>(draw));
    if (!plane) continue;
    const std::size_t count = pointsOn(grid, *plane, kCountEvery).size();
    if (count > most) {
      most = count;
      best = *plane;
    }
  }
  constexpr std::size_t kLeastPoints = 10;
  std::vector<std::size_t> on;
  for (int k = 0; k < kRefinements; ++k) {
    on = pointsOn(grid, best, 1);
    if (most == 0 || on.size() < kLeastPoints) return std::nullopt;
    best = fitted(grid, on);
  }
  on = pointsOn(grid, best, 1);
  best.share = static_cast<double>(on.size()) / grid.count;
  for (const std::size_t i : on) best.points.push_back(grid.points[i]);
  if (best.share < kLeastShare) return std::nullopt;
  return best;
}

}  // namespace

double planeToleranceM(double z) {
  constexpr double kLeastM = 0.003, kNoisePerM = 2.0 * 1.425e-3;
  return kLeastM + kNoisePerM * z * z;
}

std::vector<ImagePlane> findPlanes(const DepthImageView& depth, const PinholeCamera& camera, double max_depth_m) {
  const CounterRandom random(1);
  PointGrid grid = makeGrid(depth, camera, max_depth_m);
  std::vector<ImagePlane> planes;
  for (int round = 0; round < kMostPlanes && grid.count > 0; ++round) {
    const auto plane = findLargest(grid, random, round);
    if (!plane) break;
    for (const std::size_t i : pointsOn(grid, *plane, 1)) grid.is_free[i] = false;
    planes.push_back(*plane);
  }
  std::stable_sort(planes.begin(), planes.end(),
                   [](const ImagePlane& a, const ImagePlane& b) { return a.share > b.share; });
  return planes;
}

}  // namespace depth_object_tracker
