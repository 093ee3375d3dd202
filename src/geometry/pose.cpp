// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/geometry/pose.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {

Eigen::Matrix3d skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return matrix;
}

Eigen::Matrix3d expSo3(const Eigen::Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  // Half-angle quaternion: sin(a/2)/a by its series below 1e-4 rad, where the quotient loses digits.
  const double half_sinc = angle < 1e-4 ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
  Eigen::Quaterniond quaternion;
  quaternion.w() = std::cos(0.5 * angle);
  quaternion.vec() = half_sinc * rotation_vector;
  return quaternion.normalized().toRotationMatrix();
}

Eigen::Vector3d logSo3(const Eigen::Matrix3d& rotation) {
  // Through the quaternion: Shepperd's branch keeps every digit near pi, where the antisymmetric part vanishes.
  Eigen::Quaterniond quaternion(rotation);
  quaternion.normalize();
  if (quaternion.w() < 0.0) quaternion.coeffs() = -quaternion.coeffs();
  const double sine = quaternion.vec().norm();
  if (sine < 1e-10) return 2.0 * quaternion.vec();
  return 2.0 * std::atan2(sine, quaternion.w()) / sine * quaternion.vec();
}

double rotationAngle(const Eigen::Matrix3d& rotation) {
  return logSo3(rotation).norm();
}

Pose perturb(const Pose& pose, const Vector6d& delta) {
  Pose result = Pose::Identity();
  result.translation() = pose.translation() + delta.head<3>();
  result.linear() = expSo3(delta.tail<3>()) * pose.linear();
  return result;
}

Vector6d difference(const Pose& to, const Pose& from) {
  Vector6d delta;
  delta.head<3>() = to.translation() - from.translation();
  delta.tail<3>() = logSo3(to.linear() * from.linear().transpose());
  return delta;
}

Vector6d poseVariances(double position_stddev_m, double rotation_stddev_rad) {
  Vector6d variances;
  variances.head<3>().setConstant(position_stddev_m * position_stddev_m);
  variances.tail<3>().setConstant(rotation_stddev_rad * rotation_stddev_rad);
  return variances;
}

Matrix6d transportCovariance(const Matrix6d& covariance, const Eigen::Vector3d& offset_camera) {
  Matrix6d jacobian = Matrix6d::Identity();
  jacobian.topRightCorner<3, 3>() = -skew(offset_camera);
  return jacobian * covariance * jacobian.transpose();
}

Vector6d rotated(const Vector6d& vector, const Eigen::Matrix3d& R_target_source) {
  Vector6d result;
  result << R_target_source * vector.head<3>(), R_target_source * vector.tail<3>();
  return result;
}

Matrix6d rotated(const Matrix6d& covariance, const Eigen::Matrix3d& R_target_source) {
  Matrix6d turn = Matrix6d::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = R_target_source;
  return turn * covariance * turn.transpose();
}

bool isValidPose(const Pose& pose) {
  if (!pose.matrix().allFinite()) return false;
  const Eigen::Matrix3d gram = pose.linear() * pose.linear().transpose();
  return (gram - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-6 && pose.linear().determinant() > 0.0;
}

}  // namespace depth_object_tracker
