// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/point_pairs.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

constexpr double kLeastPerDiameter = 0.2, kMostPerDiameter = 1.0, kStepPerDiameter = 0.06;
constexpr double kAngleStep = 14.0 * M_PI / 180.0;
constexpr std::uint32_t kAngleCells = 16;
constexpr std::size_t kMostPoints = 250;
constexpr std::array<double, 4> kMiddle{0.5, 0.5, 0.5, 0.5};

double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(a.dot(b), -1.0, 1.0));
}

/// Axes of a pair: the first normal, and the second point's direction around it.
std::optional<Eigen::Matrix3d> pairAxes(const OrientedPoint& first, const OrientedPoint& second, double least_m) {
  constexpr double kLeastShare = 0.35;
  const Eigen::Vector3d line = second.point - first.point;
  const Eigen::Vector3d aside = line - line.dot(first.normal) * first.normal;
  if (aside.norm() < kLeastShare * least_m) return std::nullopt;
  Eigen::Matrix3d axes;
  axes.col(0) = first.normal;
  axes.col(1) = aside.normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

}  // namespace

PairFeature pairFeature(const OrientedPoint& first, const OrientedPoint& second) {
  const Eigen::Vector3d line = second.point - first.point;
  const double distance = std::max(line.norm(), 1e-9);
  const Eigen::Vector3d direction = line / distance;
  return {distance, angleBetween(first.normal, direction), angleBetween(second.normal, direction),
          angleBetween(first.normal, second.normal)};
}

PointPairs::PointPairs(const std::vector<OrientedPoint>& points, double diameter_m)
    : least_m_(kLeastPerDiameter * diameter_m),
      most_m_(kMostPerDiameter * diameter_m),
      distance_step_m_(kStepPerDiameter * diameter_m) {
  const std::size_t stride = std::max<std::size_t>(1, (points.size() + kMostPoints - 1) / kMostPoints);
  for (std::size_t i = 0; i < points.size(); i += stride) points_.push_back(points[i]);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    for (std::size_t j = 0; j < points_.size(); ++j) {
      const PairFeature feature = pairFeature(points_[i], points_[j]);
      if (i == j || feature.distance_m < least_m_) continue;
      constexpr double kSeenTogether = 0.9 * M_PI;  // of normals: otherwise no camera sees both
      if (feature.normals_rad > kSeenTogether || !pairAxes(points_[i], points_[j], least_m_)) continue;
      entries_.push_back({cellOf(feature, kMiddle), static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(j),
                          static_cast<float>(turnAbout(axesOf(points_[i]), points_[i], points_[j]))});
    }
  }
  std::stable_sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.cell < b.cell; });
  const std::uint32_t cells = entries_.empty() ? 0 : entries_.back().cell + 1;
  std::uint32_t entry = 0;
  for (std::uint32_t cell = 0; cell <= cells; ++cell) {
    while (entry < entries_.size() && entries_[entry].cell < cell) ++entry;
    start_.push_back(entry);
  }
}

std::uint32_t PointPairs::cellOf(const PairFeature& feature, const std::array<double, 4>& jitter) const {
  const auto cell = [](double value, double step, double offset) {
    return static_cast<std::uint32_t>(std::max(0.0, value / step + offset - 0.5));
  };
  return ((cell(feature.distance_m, distance_step_m_, jitter[0]) * kAngleCells +
           cell(feature.first_rad, kAngleStep, jitter[1])) *
              kAngleCells +
          cell(feature.second_rad, kAngleStep, jitter[2])) *
             kAngleCells +
         cell(feature.normals_rad, kAngleStep, jitter[3]);
}

std::optional<Pose> PointPairs::layOn(const OrientedPoint& first, const OrientedPoint& second,
                                      const std::array<double, 4>& jitter, double choice) const {
  const auto axes_camera = pairAxes(first, second, least_m_);
  if (!axes_camera) return std::nullopt;
  const auto [begin, end] = alike(first, second, jitter);
  if (begin == end) return std::nullopt;
  const Entry& entry = *(begin + static_cast<std::ptrdiff_t>(choice * static_cast<double>(end - begin)));
  const OrientedPoint& own = points_[entry.first];
  const auto axes_object = pairAxes(own, points_[entry.second], least_m_);
  Pose pose = Pose::Identity();
  pose.linear() = *axes_camera * axes_object->transpose();
  // Halfway between the two points' places, which differ a little.
  const Eigen::Vector3d middle_object = 0.5 * (own.point + points_[entry.second].point);
  pose.translation() = 0.5 * (first.point + second.point) - pose.linear() * middle_object;
  return pose;
}

std::pair<const PointPairs::Entry*, const PointPairs::Entry*> PointPairs::alike(
    const OrientedPoint& first, const OrientedPoint& second, const std::array<double, 4>& jitter) const {
  const PairFeature feature = pairFeature(first, second);
  if (feature.distance_m < least_m_ || feature.distance_m > most_m_) return {nullptr, nullptr};
  const std::uint32_t cell = cellOf(feature, jitter);
  if (cell + 1 >= start_.size()) return {nullptr, nullptr};
  return {entries_.data() + start_[cell], entries_.data() + start_[cell + 1]};
}

Eigen::Matrix3d axesOf(const OrientedPoint& point) {
  Eigen::Matrix3d axes;
  axes.col(0) = point.normal;
  axes.col(1) = point.normal.unitOrthogonal();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

double turnAbout(const Eigen::Matrix3d& axes, const OrientedPoint& point, const OrientedPoint& other) {
  const Eigen::Vector3d line = other.point - point.point;
  return std::atan2(line.dot(axes.col(2)), line.dot(axes.col(1)));
}

}  // namespace depth_object_tracker
