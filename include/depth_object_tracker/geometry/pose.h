// SPDX-License-Identifier: BSD-3-Clause
// Rigid poses and their 6-vector perturbations (REP-103 order, fixed axes).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace depth_object_tracker {

/// T_target_source: p_target = T_target_source * p_source.
using Pose = Eigen::Isometry3d;
/// [x y z rx ry rz] in m and rad, along the fixed axes of the target frame: t' = t + dt, R' = Exp(dtheta) R.
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Cross-product matrix: skew(a) * b = a x b.
Eigen::Matrix3d skew(const Eigen::Vector3d& a);

/// Rotation by |rotation_vector| rad about its direction; exact series near zero.
Eigen::Matrix3d expSo3(const Eigen::Vector3d& rotation_vector);

/// Inverse of expSo3 with norm in [0, pi]; well-conditioned near 0 and near pi.
Eigen::Vector3d logSo3(const Eigen::Matrix3d& rotation);

/// By how much it turns [rad], 0 to pi.
double rotationAngle(const Eigen::Matrix3d& rotation);

/// Applies a perturbation: translation added, rotation applied from the left (axes of the target frame).
Pose perturb(const Pose& pose, const Vector6d& delta);

/// The perturbation that takes `from` to `to`: perturb(from, difference(to, from)) == to.
Vector6d difference(const Pose& to, const Pose& from);

/// Variances of perturbations that are alike in all directions [m^2, rad^2].
/// @param position_stddev_m, rotation_stddev_rad >= 0, about each axis.
Vector6d poseVariances(double position_stddev_m, double rotation_stddev_rad);

/// Moves a covariance of perturbations from a body point to the point `offset_camera` = R * (point_new - point_old)
/// away from it: C_new = J C J^T with J = [I, -[offset]x; 0, I]. For the mesh origin seen from the centre c,
/// offset = -R c, so J = [I, [R c]x; 0, I].
Matrix6d transportCovariance(const Matrix6d& covariance, const Eigen::Vector3d& offset_camera);

/// A 6-vector (perturbation or twist of a point) told in other fixed axes: both halves turned by R_target_source.
Vector6d rotated(const Vector6d& vector, const Eigen::Matrix3d& R_target_source);

/// Its covariance told in other fixed axes.
Matrix6d rotated(const Matrix6d& covariance, const Eigen::Matrix3d& R_target_source);

/// True when all entries are finite and the rotation is orthonormal to 1e-6.
bool isValidPose(const Pose& pose);

}  // namespace depth_object_tracker
