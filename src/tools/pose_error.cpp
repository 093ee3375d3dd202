// SPDX-License-Identifier: BSD-3-Clause
// Distance between an estimated and a true pose as the object's points see it.
#include "depth_object_tracker/tools/pose_error.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>

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

/// How the mesh origin's pose changes when the object turns about its symmetry axis (camera axes).
Vector6d freeDirection(const Pose& T_camera_object, const SymmetryAxis& symmetry) {
  const Eigen::Vector3d axis = T_camera_object.linear() * symmetry.axis;
  Vector6d direction;
  direction << axis.cross(T_camera_object.linear() * -symmetry.offset), axis;
  return direction;
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

std::optional<double> PoseErrorMeter::normalisedErrorSquared(const Pose& T_camera_object_estimate,
                                                             const Matrix6d& covariance,
                                                             const Pose& T_camera_object_truth) const {
  const Pose T_folded = symmetric() ? foldOntoReference(T_camera_object_estimate, T_camera_object_truth, symmetries_)
                                    : T_camera_object_estimate;
  const Vector6d error = difference(T_camera_object_truth, T_folded);
  Eigen::MatrixXd basis = Matrix6d::Identity();
  if (degreesOfFreedom() == 5) {
    const Eigen::Matrix<double, 6, 1> free = freeDirection(T_camera_object_estimate, symmetries_.continuous.front());
    const Matrix6d q = free.householderQr().householderQ();
    basis = q.rightCols<5>();
  }
  const Eigen::VectorXd e = basis.transpose() * error;
  const Eigen::LLT<Eigen::MatrixXd> factor(basis.transpose() * covariance * basis);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const double squared = e.dot(factor.solve(e));
  return std::isfinite(squared) ? std::optional<double>(squared) : std::nullopt;
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
