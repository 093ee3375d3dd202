// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/fiducials/fiducial_points.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <optional>

namespace depth_object_tracker {
namespace {

constexpr double kMinDisparityPx = 0.5;
constexpr std::size_t kMinReadings = 12;  // for a plane through a tag's depth
constexpr double kMinReadingShare = 0.6;  // of the tag's pixels, on the plane
constexpr double kPlaneReachM = 0.015;    // readings farther from the median plane belong to something else

const TagDetection* findTag(const std::vector<TagDetection>& detections, int id) {
  for (const TagDetection& detection : detections) {
    if (detection.id == id) return &detection;
  }
  return nullptr;
}

/// Point and covariance of u, v (left), d = disparity, by the derivatives of the triangulation.
std::optional<FiducialPoint> triangulate(const Eigen::Vector2d& left, const Eigen::Vector2d& right,
                                         const StereoCamera& camera, const FiducialNoise& noise) {
  const double disparity = left.x() - right.x();
  if (disparity < kMinDisparityPx || std::abs(left.y() - right.y()) > noise.max_row_difference_px) return std::nullopt;
  const double z = camera.left.fx * camera.baseline_m / disparity;
  const Eigen::Vector3d ray = camera.left.ray(left.x(), 0.5 * (left.y() + right.y()));
  FiducialPoint point;
  point.p_camera = z * ray;
  const double variance = noise.corner_stddev_px * noise.corner_stddev_px;
  Eigen::Matrix<double, 3, 3> jacobian = Eigen::Matrix3d::Zero();  // to u_left, u_right, v
  jacobian.col(0) = -z / disparity * ray + Eigen::Vector3d(z / camera.left.fx, 0.0, 0.0);
  jacobian.col(1) = z / disparity * ray;
  jacobian.col(2) = Eigen::Vector3d(0.0, z / camera.left.fy, 0.0);
  point.covariance = jacobian * Eigen::Vector3d(variance, variance, 0.5 * variance).asDiagonal() * jacobian.transpose();
  return point;
}

bool isInside(const std::array<Eigen::Vector2d, 4>& corners, const Eigen::Vector2d& pixel) {
  int positive = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Vector2d edge = corners[(k + 1) % 4] - corners[k], to_pixel = pixel - corners[k];
    positive += edge.x() * to_pixel.y() - edge.y() * to_pixel.x() > 0.0 ? 1 : 0;
  }
  return positive == 0 || positive == 4;
}

/// Readings inside of the tag as (u, v, 1/z): planes are linear in it.
std::vector<Eigen::Vector3d> readingsInside(const std::array<Eigen::Vector2d, 4>& corners, const DepthImageView& depth,
                                            std::size_t& num_pixels) {
  Eigen::Vector2d low = corners[0], high = corners[0];
  for (const Eigen::Vector2d& corner : corners) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  std::vector<Eigen::Vector3d> readings;
  num_pixels = 0;
  for (int row = std::max(0, static_cast<int>(low.y())); row <= std::min(depth.height - 1, static_cast<int>(high.y()));
       ++row) {
    for (int col = std::max(0, static_cast<int>(low.x())); col <= std::min(depth.width - 1, static_cast<int>(high.x()));
         ++col) {
      if (!isInside(corners, {col, row})) continue;
      ++num_pixels;
      const float z = depth.at(row, col);
      if (std::isfinite(z)) readings.emplace_back(col, row, 1.0 / static_cast<double>(z));
    }
  }
  return readings;
}

/// 1/z = plane . (u - middle u, v - middle v, 1); nullopt when the readings do not lie in one plane.
struct InversePlane {
  Eigen::Vector2d middle;
  Eigen::Vector3d coefficients;
  double inverseDepth(const Eigen::Vector2d& pixel) const {
    return coefficients.dot(Eigen::Vector3d(pixel.x() - middle.x(), pixel.y() - middle.y(), 1.0));
  }
};

std::optional<InversePlane> fitPlane(std::vector<Eigen::Vector3d> readings, std::size_t num_pixels) {
  const auto enough = [&] {
    return readings.size() >=
           std::max(kMinReadings, static_cast<std::size_t>(kMinReadingShare * static_cast<double>(num_pixels)));
  };
  if (!enough()) return std::nullopt;
  InversePlane plane;
  for (int round = 0; round < 3; ++round) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& reading : readings) mean += reading / static_cast<double>(readings.size());
    plane.middle = mean.head<2>();
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& reading : readings) {
      const Eigen::Vector3d row(reading.x() - mean.x(), reading.y() - mean.y(), 1.0);
      normal += row * row.transpose();
      right += row * reading.z();
    }
    plane.coefficients = normal.ldlt().solve(right);
    if (!plane.coefficients.allFinite()) return std::nullopt;
    const auto is_off = [&](const Eigen::Vector3d& reading) {
      return !(std::abs(1.0 / reading.z() - 1.0 / plane.inverseDepth(reading.head<2>())) < kPlaneReachM);
    };
    readings.erase(std::remove_if(readings.begin(), readings.end(), is_off), readings.end());
    if (!enough()) return std::nullopt;
  }
  return plane;
}

}  // namespace

std::vector<FiducialPoint> triangulateTags(const FiducialMap& map, const std::vector<TagDetection>& left,
                                           const std::vector<TagDetection>& right, const StereoCamera& camera,
                                           const FiducialNoise& noise) {
  std::vector<FiducialPoint> points;
  for (const TagDetection& in_left : left) {
    const Fiducial* tag = map.find(in_left.id);
    const TagDetection* in_right = findTag(right, in_left.id);
    if (tag == nullptr || in_right == nullptr) continue;
    const auto corners = tag->corners();
    for (std::size_t k = 0; k < corners.size(); ++k) {
      auto point = triangulate(in_left.corners[k], in_right->corners[k], camera, noise);
      if (!point) continue;
      point->tag_id = tag->id;
      point->p_object = corners[k];
      points.push_back(*point);
    }
  }
  return points;
}

std::vector<FiducialPoint> locateTagsByDepth(const FiducialMap& map, const std::vector<TagDetection>& detections,
                                             const DepthImageView& depth, const PinholeCamera& camera,
                                             const FiducialNoise& noise) {
  std::vector<FiducialPoint> points;
  for (const TagDetection& detection : detections) {
    const Fiducial* tag = map.find(detection.id);
    if (tag == nullptr) continue;
    std::size_t num_pixels = 0;
    auto readings = readingsInside(detection.corners, depth, num_pixels);
    const auto plane = fitPlane(std::move(readings), num_pixels);
    if (!plane) continue;
    const auto corners = tag->corners();
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Eigen::Vector2d& pixel = detection.corners[k];
      const double inverse = plane->inverseDepth(pixel);
      if (!(inverse > 0.0)) continue;
      const Eigen::Vector3d ray = camera.ray(pixel.x(), pixel.y());
      const double across = noise.corner_stddev_px / inverse;
      FiducialPoint point;
      point.tag_id = tag->id;
      point.p_object = corners[k];
      point.p_camera = ray / inverse;
      point.covariance = noise.depth_stddev_m * noise.depth_stddev_m * ray * ray.transpose();
      point.covariance(0, 0) += std::pow(across / camera.fx, 2);
      point.covariance(1, 1) += std::pow(across / camera.fy, 2);
      points.push_back(point);
    }
  }
  return points;
}

}  // namespace depth_object_tracker
