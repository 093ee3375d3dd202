// SPDX-License-Identifier: BSD-3-Clause
// Folding of poses that a symmetric object cannot tell apart.
#include "depth_object_tracker/geometry/symmetry.h"

#include <cmath>

namespace depth_object_tracker {
namespace {

/// Poses count as different only beyond this, so that ties go to the pose as it is: |cos| of the half angle between
/// them.
constexpr double kTieTolerance = 1e-9;

Pose rotationAboutPoint(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& point) {
  Pose pose = Pose::Identity();
  pose.linear() = rotation;
  pose.translation() = point - rotation * point;
  return pose;
}

/// |cos| of half the angle between two orientations: 1 when equal.
double alignment(const Pose& a, const Pose& b) {
  return std::abs(Eigen::Quaterniond(a.linear()).normalized().dot(Eigen::Quaterniond(b.linear()).normalized()));
}

bool areParallel(const SymmetryAxis& a, const SymmetryAxis& b) {
  return a.axis.cross(b.axis).norm() < 1e-6;
}

/// The point where two axes meet (the middle of the shortest connection when they miss each other).
Eigen::Vector3d commonPoint(const SymmetryAxis& a, const SymmetryAxis& b) {
  const Eigen::Vector3d between = b.offset - a.offset;
  const double cosine = a.axis.dot(b.axis);
  const double along_a = (between.dot(a.axis) - cosine * between.dot(b.axis)) / (1.0 - cosine * cosine);
  const double along_b = (cosine * between.dot(a.axis) - between.dot(b.axis)) / (1.0 - cosine * cosine);
  return 0.5 * (a.offset + along_a * a.axis + b.offset + along_b * b.axis);
}

/// Turns about the axis until the rotation is as near as possible to the reference. With q = R_ref^T R as a quaternion,
/// the real part after turning by t is w cos(t/2) - (v . axis) sin(t/2), which is largest at t/2 = atan2(-v . axis, w).
Pose spinOntoReference(const Pose& pose, const Pose& reference, const SymmetryAxis& symmetry) {
  const Eigen::Quaterniond between(Eigen::Matrix3d(reference.linear().transpose() * pose.linear()));
  const double angle = 2.0 * std::atan2(-between.vec().dot(symmetry.axis), between.w());
  return pose * rotationAboutPoint(expSo3(angle * symmetry.axis), symmetry.offset);
}

Pose foldContinuous(const Pose& pose, const Pose& reference, const std::vector<SymmetryAxis>& axes) {
  if (axes.empty()) return pose;
  for (std::size_t i = 1; i < axes.size(); ++i) {
    // Two different axes generate every rotation (a ball): take over the reference's.
    if (areParallel(axes[0], axes[i])) continue;
    const Eigen::Matrix3d rotation = pose.linear().transpose() * reference.linear();
    return pose * rotationAboutPoint(rotation, commonPoint(axes[0], axes[i]));
  }
  return spinOntoReference(pose, reference, axes[0]);
}

}  // namespace

Pose foldOntoReference(const Pose& T_camera_object, const Pose& T_camera_object_reference,
                       const Symmetries& symmetries) {
  if (symmetries.empty()) return T_camera_object;
  Pose best = foldContinuous(T_camera_object, T_camera_object_reference, symmetries.continuous);
  double best_alignment = alignment(best, T_camera_object_reference);
  for (const Pose& T_object_object : symmetries.discrete) {
    const Pose candidate =
        foldContinuous(T_camera_object * T_object_object, T_camera_object_reference, symmetries.continuous);
    const double candidate_alignment = alignment(candidate, T_camera_object_reference);
    if (candidate_alignment > best_alignment + kTieTolerance) {
      best = candidate;
      best_alignment = candidate_alignment;
    }
  }
  return best;
}

std::optional<Eigen::Vector3d> freeAxisInCamera(const Pose& T_camera_object, const Symmetries& symmetries) {
  if (symmetries.continuous.size() != 1) return std::nullopt;
  return Eigen::Vector3d(T_camera_object.linear() * symmetries.continuous.front().axis).normalized();
}

}  // namespace depth_object_tracker
