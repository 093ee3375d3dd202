// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/oriented_points.h"

#include "depth_object_tracker/render/depth_renderer.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

constexpr int kPatchSide = 7;  // readings looked at along a patch's side

/// A length in pixels that is safe to reckon with: what lies a micrometre before the lens would fill millions of
/// images.
double withinImage(const DepthImageView& depth, double length_px, double least_px) {
  return std::clamp(length_px, least_px, static_cast<double>(depth.width + depth.height));
}

float readingAt(const DepthImageView& depth, int row, int col) {
  if (row < 0 || row >= depth.height || col < 0 || col >= depth.width) return 0.0f;
  const float z = depth.at(row, col);
  return z > 0.0f ? z : 0.0f;
}

/// True when the surface goes on as a plane to both sides along a line of the image. Inverse depth is linear in pixel
/// coordinates on a plane.
bool isFlatAlong(const DepthImageView& depth, int row, int col, int d_row, int d_col, float z) {
  constexpr float kTolerancePerM = 0.012f;  // of depth, at 1 m; grows with its square as the noise does
  const float before = readingAt(depth, row - d_row, col - d_col), after = readingAt(depth, row + d_row, col + d_col);
  if (!(before > 0.0f) || !(after > 0.0f)) return false;
  const float middle = 2.0f / (1.0f / before + 1.0f / after);
  return std::abs(middle - z) < kTolerancePerM * z * z;
}

bool liesOnLargePlane(const DepthImageView& depth, const PinholeCamera& camera, int row, int col, float z,
                      double object_diameter_m) {
  constexpr double kReachPerDiameter = 0.55;
  constexpr int kFlatLines = 3;
  const int reach = static_cast<int>(
      withinImage(depth, kReachPerDiameter * object_diameter_m * camera.fx / static_cast<double>(z), 2.0));
  const int diagonal = reach * 7 / 10;
  return isFlatAlong(depth, row, col, 0, reach, z) + isFlatAlong(depth, row, col, reach, 0, z) +
             isFlatAlong(depth, row, col, diagonal, diagonal, z) +
             isFlatAlong(depth, row, col, diagonal, -diagonal, z) >=
         kFlatLines;
}

/// Adds `candidate` unless one like it is there.
void addIfNew(const OrientedPoint& candidate, double apart_m, std::vector<OrientedPoint>& points) {
  constexpr double kSameNormalCosine = 0.85;
  const bool known = std::any_of(points.begin(), points.end(), [&](const OrientedPoint& other) {
    return (other.point - candidate.point).squaredNorm() < apart_m * apart_m &&
           other.normal.dot(candidate.normal) > kSameNormalCosine;
  });
  if (!known) points.push_back(candidate);
}

template <typename Wanted>
std::vector<OrientedPoint> pointsWhere(const DepthImageView& depth, const PinholeCamera& camera, double reach_m,
                                       double max_depth_m, int step_px, const Wanted& wanted) {
  std::vector<OrientedPoint> points;
  for (int row = step_px / 2; row < depth.height; row += step_px) {
    for (int col = step_px / 2; col < depth.width; col += step_px) {
      const float z = readingAt(depth, row, col);
      if (!(z > 0.0f && z <= static_cast<float>(max_depth_m)) || !wanted(row, col, z)) continue;
      if (const auto point = orientedPointAt(depth, camera, row, col, reach_m)) points.push_back(*point);
    }
  }
  return points;
}

}  // namespace

std::optional<OrientedPoint> orientedPointAt(const DepthImageView& depth, const PinholeCamera& camera, int row, int col,
                                             double reach_m) {
  constexpr int kLeastReadings = 12;
  constexpr double kLargestRatio = 0.15;  // of the patch's thickness to its breadth
  const auto z = static_cast<double>(readingAt(depth, row, col));
  if (!(z > 0.0)) return std::nullopt;
  const double step_px = withinImage(depth, 2.0 * reach_m * camera.fx / z / (kPatchSide - 1), 1.0);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  int count = 0;
  for (int i = -kPatchSide / 2; i <= kPatchSide / 2; ++i) {
    for (int j = -kPatchSide / 2; j <= kPatchSide / 2; ++j) {
      const int r = row + static_cast<int>(std::lround(i * step_px)),
                c = col + static_cast<int>(std::lround(j * step_px));
      const auto reading = static_cast<double>(readingAt(depth, r, c));
      if (!(reading > 0.0) || std::abs(reading - z) > 1.5 * reach_m) continue;
      const Eigen::Vector3d p = reading * camera.ray(c, r);
      mean += p;
      scatter += p * p.transpose();
      ++count;
    }
  }
  if (count < kLeastReadings) return std::nullopt;
  mean /= count;
  scatter = scatter / count - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter);
  if (axes.eigenvalues()[0] > kLargestRatio * axes.eigenvalues()[1]) return std::nullopt;
  Eigen::Vector3d normal = axes.eigenvectors().col(0);
  if (normal.dot(mean) > 0.0) normal = -normal;
  return OrientedPoint{mean, normal};
}

std::vector<OrientedPoint> imagePoints(const DepthImageView& depth, const PinholeCamera& camera,
                                       double object_diameter_m, double reach_m, double max_depth_m, int step_px) {
  return pointsWhere(depth, camera, reach_m, max_depth_m, step_px, [&](int row, int col, float z) {
    return !liesOnLargePlane(depth, camera, row, col, z, object_diameter_m);
  });
}

std::vector<OrientedPoint> allImagePoints(const DepthImageView& depth, const PinholeCamera& camera, double reach_m,
                                          double max_depth_m, int step_px) {
  return pointsWhere(depth, camera, reach_m, max_depth_m, step_px, [](int, int, float) { return true; });
}

std::vector<OrientedPoint> objectPoints(const TriangleMesh& mesh, const Eigen::Vector3d& centre_object) {
  constexpr int kViews = 60;
  constexpr double kDistanceInDiameters = 4.0, kApartPerSize = 0.09;
  const double diameter_m = std::max(diameter(mesh), 1e-6), distance = kDistanceInDiameters * diameter_m;
  const double feature_m = featureSize(mesh, diameter_m);
  // A thin object needs a finer picture: the patches are smaller.
  const int image_size = static_cast<int>(std::lround(96.0 * std::min(3.0, diameter_m / feature_m)));
  constexpr int kStep = 5;
  const PinholeCamera camera{image_size,
                             image_size,
                             0.9 * image_size * kDistanceInDiameters,
                             0.9 * image_size * kDistanceInDiameters,
                             0.5 * (image_size - 1),
                             0.5 * (image_size - 1)};
  DepthRenderer renderer(mesh);
  std::vector<OrientedPoint> points;
  std::vector<float> image(static_cast<std::size_t>(image_size * image_size));
  DepthImageView view;
  view.data = reinterpret_cast<const std::uint8_t*>(image.data());
  view.width = view.height = image_size;
  view.step = image_size * sizeof(float);
  view.pixel_type = DepthImageView::PixelType::kFloat32;
  view.unit_m = 1.0;
  for (int index = 0; index < kViews; ++index) {
    const Eigen::Matrix3d R = evenlySpreadRotation(static_cast<std::size_t>(index));
    Pose T_camera_object = Pose::Identity();
    T_camera_object.linear() = R;
    T_camera_object.translation() = Eigen::Vector3d(0.0, 0.0, distance) - R * centre_object;
    std::fill(image.begin(), image.end(), 0.0f);
    for (const CoveredPixel& pixel : renderer.render(T_camera_object, camera)) {
      const int cell = pixel.row * image_size + pixel.col;
      image[static_cast<std::size_t>(cell)] = pixel.depth;
    }
    for (int row = kStep / 2; row < image_size; row += kStep) {
      for (int col = kStep / 2; col < image_size; col += kStep) {
        const auto seen = orientedPointAt(view, camera, row, col, kPatchReachPerSize * feature_m);
        if (!seen) continue;
        const Eigen::Vector3d from_centre = seen->point - Eigen::Vector3d(0.0, 0.0, distance);
        addIfNew({R.transpose() * from_centre, R.transpose() * seen->normal}, kApartPerSize * feature_m, points);
      }
    }
  }
  return points;
}

double featureSize(const TriangleMesh& mesh, double diameter_m) {
  double area = 0.0;
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[triangle[0]].cast<double>();
    const Eigen::Vector3d b = mesh.vertices[triangle[1]].cast<double>(), c = mesh.vertices[triangle[2]].cast<double>();
    area += 0.5 * (b - a).cross(c - a).norm();
  }
  // A convex body shows a quarter of its surface on average (Cauchy); a cube gets its diameter.
  constexpr double kLeastShare = 0.25;
  return std::clamp(M_SQRT2 * std::sqrt(0.25 * area), kLeastShare * diameter_m, diameter_m);
}

Pose layOn(const OrientedPoint& image_point, const OrientedPoint& object_point, double turn_rad) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(turn_rad, image_point.normal).toRotationMatrix() *
                  Eigen::Quaterniond::FromTwoVectors(object_point.normal, image_point.normal).toRotationMatrix();
  pose.translation() = image_point.point - pose.linear() * object_point.point;
  return pose;
}

Eigen::Matrix3d evenlySpreadRotation(std::size_t index) {
  // Additive recurrence with the generalised golden ratio of three dimensions (root of x^4 = x + 1), mapped to unit
  // quaternions as Shoemake (Graphics Gems III, 1992) does with uniform numbers.
  constexpr double kRatio = 1.2207440846057594;
  const auto fraction = [&](double power) {
    const double value = 0.5 + static_cast<double>(index) / power;
    return value - std::floor(value);
  };
  const double u1 = fraction(kRatio), u2 = fraction(kRatio * kRatio), u3 = fraction(kRatio * kRatio * kRatio);
  const double a = std::sqrt(1.0 - u1), b = std::sqrt(u1);
  const Eigen::Quaterniond q(b * std::cos(2.0 * M_PI * u3), a * std::sin(2.0 * M_PI * u2),
                             a * std::cos(2.0 * M_PI * u2), b * std::sin(2.0 * M_PI * u3));
  return q.normalized().toRotationMatrix();
}

}  // namespace depth_object_tracker
