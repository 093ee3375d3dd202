// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/fiducials/fiducial_pose.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace depth_object_tracker {
namespace {

constexpr int kRefinements = 3;
constexpr double kMinSpreadM = 0.003;  // second axis of the points: less is a line

bool lieOnLine(const Eigen::Matrix3Xd& points) {
  const Eigen::Matrix3Xd centred = points.colwise() - points.rowwise().mean();
  const Eigen::Matrix3d scatter = centred * centred.transpose() / static_cast<double>(points.cols());
  const Eigen::Vector3d variances = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvalues();
  return variances[1] < kMinSpreadM * kMinSpreadM;
}

std::optional<Pose> closedForm(const std::vector<FiducialPoint>& points) {
  if (points.size() < 3) return std::nullopt;
  Eigen::Matrix3Xd object(3, static_cast<Eigen::Index>(points.size())), camera(3, object.cols());
  for (Eigen::Index k = 0; k < object.cols(); ++k) {
    object.col(k) = points[static_cast<std::size_t>(k)].p_object;
    camera.col(k) = points[static_cast<std::size_t>(k)].p_camera;
  }
  if (lieOnLine(object)) return std::nullopt;
  return Pose(Eigen::umeyama(object, camera, false));
}

/// Gauss-Newton with the points' covariances; fills pose and its covariance.
void refine(const std::vector<FiducialPoint>& points, FiducialPose& pose) {
  for (int step = 0; step < kRefinements; ++step) {
    Matrix6d information = Matrix6d::Zero();
    Vector6d gradient = Vector6d::Zero();
    for (const FiducialPoint& point : points) {
      const Eigen::Vector3d lever = pose.T_camera_object.linear() * point.p_object;
      Eigen::Matrix<double, 3, 6> jacobian;
      jacobian << Eigen::Matrix3d::Identity(), -skew(lever);
      const Eigen::Matrix3d weight = point.covariance.inverse();
      information += jacobian.transpose() * weight * jacobian;
      gradient += jacobian.transpose() * weight * (point.p_camera - pose.T_camera_object * point.p_object);
    }
    pose.T_camera_object = perturb(pose.T_camera_object, information.ldlt().solve(gradient));
    pose.covariance = information.inverse();
  }
}

double squaredResidual(const FiducialPoint& point, const Pose& T_camera_object) {
  return (point.p_camera - T_camera_object * point.p_object).squaredNorm();
}

/// The tag that fits the closed-form pose of all the others worst. Of two tags that contradict one another nobody knows
/// which is wrong.
int worstTag(const std::vector<FiducialPoint>& points, const Pose& T_camera_object) {
  std::map<int, double> sums;
  for (const FiducialPoint& point : points) sums[point.tag_id] += squaredResidual(point, T_camera_object);
  const auto by_sum = [](const auto& a, const auto& b) { return a.second < b.second; };
  return std::max_element(sums.begin(), sums.end(), by_sum)->first;
}

int countTags(const std::vector<FiducialPoint>& points) {
  std::set<int> ids;
  for (const FiducialPoint& point : points) ids.insert(point.tag_id);
  return static_cast<int>(ids.size());
}

double rootMeanSquare(const std::vector<FiducialPoint>& points, const Pose& T_camera_object) {
  double sum = 0.0;
  for (const FiducialPoint& point : points) sum += squaredResidual(point, T_camera_object);
  return std::sqrt(sum / static_cast<double>(points.size()));
}

}  // namespace

std::optional<FiducialPose> fitFiducialPose(std::vector<FiducialPoint> points, double max_rms_m) {
  for (;;) {
    const auto initial = closedForm(points);
    if (!initial) return std::nullopt;
    const double rms_m = rootMeanSquare(points, *initial);
    const int num_tags = countTags(points);
    if (rms_m <= max_rms_m) {
      FiducialPose pose;
      pose.T_camera_object = *initial;
      pose.num_tags = num_tags;
      pose.rms_m = rms_m;
      refine(points, pose);
      if (!isValidPose(pose.T_camera_object) || !pose.covariance.allFinite()) return std::nullopt;
      return pose;
    }
    if (num_tags <= 2) return std::nullopt;
    const int worst = worstTag(points, *initial);
    const auto is_worst = [&](const FiducialPoint& point) { return point.tag_id == worst; };
    points.erase(std::remove_if(points.begin(), points.end(), is_worst), points.end());
  }
}

}  // namespace depth_object_tracker
