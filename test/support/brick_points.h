// SPDX-License-Identifier: BSD-3-Clause
// Oriented points of an object that looks like nothing but itself, and of it in an image.
#pragma once

#include "depth_object_tracker/tracker/oriented_points.h"

#include <Eigen/Geometry>

#include <vector>

namespace depth_object_tracker {

constexpr double kBrickDiameterM = 0.196;

/// Three sides of a brick with unequal edges, as a camera sees them.
inline std::vector<OrientedPoint> brickPoints() {
  std::vector<OrientedPoint> points;
  const Eigen::Vector3d half(0.03, 0.05, 0.08);
  constexpr int kSteps = 7;
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; j < kSteps; ++j) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        OrientedPoint point{Eigen::Vector3d::Zero(), Eigen::Vector3d::Unit(axis)};
        point.point[axis] = half[axis];
        point.point[u] = half[u] * (2.0 * (i + 0.5) / kSteps - 1.0);
        point.point[v] = half[v] * (2.0 * (j + 0.5) / kSteps - 1.0);
        points.push_back(point);
      }
    }
  }
  return points;
}

/// Turned, 0.8 m before a camera.
inline Pose somewhere() {
  Pose T = Pose::Identity();
  T.linear() = Eigen::AngleAxisd(1.2, Eigen::Vector3d(0.3, -0.8, 0.5).normalized()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(0.1, -0.05, 0.8);
  return T;
}

/// The object's points at T_camera_object, camera frame.
inline std::vector<OrientedPoint> movedBy(const Pose& T, const std::vector<OrientedPoint>& points) {
  std::vector<OrientedPoint> moved;
  for (const OrientedPoint& point : points) moved.push_back({T * point.point, T.linear() * point.normal});
  return moved;
}

}  // namespace depth_object_tracker
