// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/ros/pose_validation.h"

#include <Eigen/Eigenvalues>

#include <cmath>
#include <sstream>

namespace depth_object_tracker {
namespace {

constexpr double kMinQuaternionNorm = 1e-3;
constexpr double kMaxPositionM = 1e4;        // further away is not metres
constexpr double kRelativeTolerance = 1e-6;  // of the largest entry: rounding of whoever filled the covariance

std::string findPositionProblem(const Eigen::Vector3d& p) {
  if (p.allFinite() && p.norm() < kMaxPositionM) return "";
  std::ostringstream problem;
  problem << "the pose's position is (" << p.x() << ", " << p.y() << ", " << p.z()
          << "); it must be finite and in metres";
  return problem.str();
}

std::string findQuaternionProblem(const geometry_msgs::Quaternion& q, double norm) {
  if (std::isfinite(norm) && norm >= kMinQuaternionNorm) return "";
  std::ostringstream problem;
  problem << "the pose's orientation quaternion (x, y, z, w) = (" << q.x << ", " << q.y << ", " << q.z << ", " << q.w
          << ") has norm " << norm << "; it must be 1 (no rotation is x = y = z = 0, w = 1)";
  return problem.str();
}

std::string findCovarianceProblem(const Matrix6d& covariance) {
  std::ostringstream problem;
  for (int row = 0; row < 6; ++row) {
    for (int col = 0; col < 6; ++col) {
      const double value = covariance(row, col);
      if (!std::isfinite(value) || (row == col && value < 0.0)) {
        problem << "the pose's covariance[" << 6 * row + col << "] is " << value
                << "; entries must be finite and variances >= 0 (all zero = defaults)";
        return problem.str();
      }
    }
  }
  const double tolerance = kRelativeTolerance * covariance.cwiseAbs().maxCoeff();
  if ((covariance - covariance.transpose()).cwiseAbs().maxCoeff() > tolerance) {
    return "the pose's covariance is not symmetric";
  }
  const double smallest = Eigen::SelfAdjointEigenSolver<Matrix6d>(covariance, Eigen::EigenvaluesOnly).eigenvalues()(0);
  if (smallest < -tolerance) {
    problem << "the pose's covariance has the negative eigenvalue " << smallest
            << ": no distribution has such a covariance";
  }
  return problem.str();
}

}  // namespace

CheckedPose checkPose(const geometry_msgs::PoseWithCovariance& message) {
  CheckedPose checked;
  const auto& p = message.pose.position;
  const auto& q = message.pose.orientation;
  const Eigen::Vector3d position(p.x, p.y, p.z);
  Eigen::Quaterniond rotation(q.w, q.x, q.y, q.z);
  for (int i = 0; i < 36; ++i) checked.covariance(i / 6, i % 6) = message.covariance[static_cast<std::size_t>(i)];

  checked.problem = findPositionProblem(position);
  if (checked.problem.empty()) checked.problem = findQuaternionProblem(q, rotation.norm());
  if (checked.problem.empty()) checked.problem = findCovarianceProblem(checked.covariance);
  if (!checked.problem.empty()) return checked;

  checked.pose.translation() = position;
  checked.pose.linear() = rotation.normalized().toRotationMatrix();
  checked.covariance = 0.5 * (checked.covariance + checked.covariance.transpose()).eval();
  return checked;
}

Matrix6d fillMissingVariances(const Matrix6d& covariance, double position_stddev_m, double rotation_stddev_rad) {
  if (covariance.isZero(0.0)) return covariance;
  Matrix6d filled = covariance;
  for (int i = 0; i < 6; ++i) {
    if (filled(i, i) > 0.0) continue;
    const double stddev = i < 3 ? position_stddev_m : rotation_stddev_rad;
    filled.row(i).setZero();
    filled.col(i).setZero();
    filled(i, i) = stddev * stddev;
  }
  return filled;
}

}  // namespace depth_object_tracker
