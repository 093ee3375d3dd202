// SPDX-License-Identifier: BSD-3-Clause
// Distance between an estimated and a true pose as the object's points see it.
#include "depth_object_tracker/tools/pose_error.h"

#include <algorithm>

namespace depth_object_tracker {
namespace {

/// At most `count` of the vertices that triangles use, evenly spread over their order.
std::vector<Eigen::Vector3f> chooseVertices(const TriangleMesh& mesh, std::size_t count) {
  std::vector<char> used(mesh.vertices.size(), 0);
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) used[vertex] = 1;
  }
  std::vector<Eigen::Vector3f> all;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i]) all.push_back(mesh.vertices[i]);
  }
  if (all.size() <= count) return all;
  std::vector<Eigen::Vector3f> chosen;
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(all[i * all.size() / count]);
  return chosen;
}

}  // namespace

PoseErrorMeter::PoseErrorMeter(const TriangleMesh& mesh, Symmetries symmetries)
    : symmetries_(std::move(symmetries)),
      points_(chooseVertices(mesh, kMaxQueryPoints)),
      index_(chooseVertices(mesh, kMaxIndexPoints)) {}

double PoseErrorMeter::meanNearestDistance(const Pose& T_truth_estimate) const {
  const Eigen::Isometry3f T = T_truth_estimate.cast<float>();
  double sum = 0.0;
  for (const Eigen::Vector3f& p_object : points_) sum += static_cast<double>(index_.distance(T * p_object));
  return sum / static_cast<double>(points_.size());
}

PoseError PoseErrorMeter::measure(const Pose& T_camera_object_estimate, const Pose& T_camera_object_truth) const {
  PoseError error;
  double sum = 0.0;
  for (const Eigen::Vector3f& p_object : points_) {
    const Eigen::Vector3d p = p_object.cast<double>();
    sum += (T_camera_object_estimate * p - T_camera_object_truth * p).norm();
  }
  error.add_m = sum / static_cast<double>(points_.size());
  error.adds_m = error.add_m;
  Pose folded = T_camera_object_estimate;
  if (symmetric()) {
    error.adds_m = meanNearestDistance(T_camera_object_truth.inverse() * T_camera_object_estimate);
    folded = foldOntoReference(T_camera_object_estimate, T_camera_object_truth, symmetries_);
  }
  const Vector6d delta = difference(folded, T_camera_object_truth);
  error.translation_m = delta.head<3>().norm();
  error.rotation_rad = delta.tail<3>().norm();
  return error;
}

}  // namespace depth_object_tracker
