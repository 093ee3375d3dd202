// SPDX-License-Identifier: BSD-3-Clause
// An arm of two links.
#include "depth_object_tracker/simulator/arm.h"

#include "depth_object_tracker/geometry/shape_meshes.h"

#include <algorithm>

namespace depth_object_tracker {
namespace {

constexpr double kMinForearmDepth = -0.1;

Pose linkPose(const Eigen::Vector3d& from_camera, const Eigen::Vector3d& direction_camera) {
  Pose pose = Pose::Identity();
  pose.translation() = from_camera;
  pose.linear() = rotationWithZ(direction_camera);
  return pose;
}

}  // namespace

Arm::Arm(const ArmConfig& config) : config_(config) {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  meshes_[0] =
      makeCapsule(Eigen::Vector3d::Zero(), config.forearm_m * z, config.wrist_radius_m, config.elbow_radius_m, 28);
  meshes_[1] = makeCapsule(Eigen::Vector3d::Zero(), config.upper_arm_m * z, config.elbow_radius_m,
                           1.2 * config.elbow_radius_m, 28);
}

std::array<Pose, 2> Arm::place(const Eigen::Vector3d& wrist_camera, const Eigen::Vector3d& wrist_out_camera) const {
  const Eigen::Vector3d to_shoulder = (config_.shoulder_camera - wrist_camera).normalized();
  // Joints have limits: the forearm follows the hand only in part and leans toward the shoulder.
  Eigen::Vector3d forearm = 0.45 * wrist_out_camera + 0.6 * to_shoulder;
  // Nobody holds an elbow before the camera's eye.
  forearm.z() = std::max(forearm.z(), kMinForearmDepth);
  forearm.normalize();
  const Eigen::Vector3d elbow = wrist_camera + config_.forearm_m * forearm;
  return {linkPose(wrist_camera, forearm), linkPose(elbow, config_.shoulder_camera - elbow)};
}

}  // namespace depth_object_tracker
