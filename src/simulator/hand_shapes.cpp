// SPDX-License-Identifier: BSD-3-Clause
// A person's hand and a robot's gripper, laid onto an object by casting rays at it.
#include "depth_object_tracker/simulator/hand_shapes.h"

#include "depth_object_tracker/geometry/shape_meshes.h"
#include "depth_object_tracker/simulator/ray_cast.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

// Sizes of an adult's hand [m].
constexpr double kFingerRadius = 0.0085;
constexpr double kThumbRadius = 0.0105;
constexpr double kFingerLength = 0.085;
constexpr double kThumbLength = 0.06;
constexpr double kFingerSpacing = 0.02;
constexpr double kPalmHalfThickness = 0.014;
constexpr double kMaxHandReach = 0.06;  // from the held centre to the surface below the fingers
constexpr double kCastFrom = 0.4;       // rays start this far outside

Pose poseOfAxes(const Eigen::Vector3d& x, const Eigen::Vector3d& y, const Eigen::Vector3d& origin) {
  Pose pose = Pose::Identity();
  pose.linear() << x, y, x.cross(y);
  pose.translation() = origin;
  return pose;
}

// Distance from `target` to the outermost surface in a direction; 0 when a ray from outside to it meets nothing.
double reach(const TriangleMesh& object, const Eigen::Vector3d& target, const Eigen::Vector3d& direction) {
  const auto hit = castRay(object, target + kCastFrom * direction, -direction);
  return hit && *hit < kCastFrom ? kCastFrom - *hit : 0.0;
}

// Joints of a finger that follows the surface, turning from `begin_deg` to `end_deg` about the lateral axis.
std::vector<Eigen::Vector3d> wrapFinger(const TriangleMesh& object, const GraspFrame& grasp, double lateral_m,
                                        double radius_m, double length_m, double begin_deg, double end_deg) {
  std::vector<Eigen::Vector3d> joints;
  const Eigen::Vector3d middle = grasp.centre + lateral_m * grasp.lateral();
  const double step = begin_deg < end_deg ? 20.0 : -20.0;
  double length = 0.0;
  for (double deg = begin_deg; std::abs(deg - begin_deg) <= std::abs(end_deg - begin_deg); deg += step) {
    const double angle = deg * M_PI / 180.0;
    const Eigen::Vector3d direction = std::cos(angle) * grasp.approach + std::sin(angle) * grasp.closing;
    const double distance = std::max(reach(object, middle, direction), 0.006) + radius_m;
    if (distance > kMaxHandReach) break;
    const Eigen::Vector3d joint = middle + distance * direction;
    if (!joints.empty()) length += (joint - joints.back()).norm();
    if (length > length_m) break;
    joints.push_back(joint);
  }
  return joints;
}

void appendChain(TriangleMesh& mesh, const std::vector<Eigen::Vector3d>& joints, double radius_m) {
  for (std::size_t k = 1; k < joints.size(); ++k) {
    appendMesh(mesh, makeCapsule(joints[k - 1], joints[k], radius_m, radius_m, 10));
  }
}

}  // namespace

std::optional<Hand> makeHumanHand(const TriangleMesh& object, const GraspFrame& grasp) {
  const double surface = reach(object, grasp.centre, grasp.approach);
  if (surface <= 0.0 || surface > kMaxHandReach) return std::nullopt;
  const Eigen::Vector3d lateral = grasp.lateral();
  const Eigen::Vector3d palm = grasp.centre + (surface + kPalmHalfThickness) * grasp.approach - 0.015 * grasp.closing;
  Hand hand;
  appendMesh(hand.mesh, makeEllipsoid({kPalmHalfThickness, 0.048, 0.044}),
             poseOfAxes(grasp.approach, grasp.closing, palm));
  for (int finger = 0; finger < 4; ++finger) {
    const double offset = (finger - 1.5) * kFingerSpacing;
    auto joints = wrapFinger(object, grasp, offset, kFingerRadius, kFingerLength, 30.0, 170.0);
    if (joints.empty()) return std::nullopt;
    joints.insert(joints.begin(), palm + 0.025 * grasp.closing + 0.9 * offset * lateral);
    appendChain(hand.mesh, joints, kFingerRadius);
  }
  auto thumb = wrapFinger(object, grasp, 0.018, kThumbRadius, kThumbLength, -40.0, -150.0);
  if (thumb.empty()) return std::nullopt;
  thumb.insert(thumb.begin(), palm - 0.025 * grasp.closing + 0.022 * lateral);
  appendChain(hand.mesh, thumb, kThumbRadius);
  hand.wrist_out = (0.55 * grasp.approach - 0.83 * grasp.closing).normalized();
  hand.wrist = palm + 0.06 * hand.wrist_out;
  appendMesh(hand.mesh, makeCapsule(palm + 0.01 * hand.wrist_out, hand.wrist, 0.024, 0.027, 16));
  return hand;
}

std::optional<Hand> makeGripper(const TriangleMesh& object, const GraspFrame& grasp) {
  constexpr double kMaxHalfOpening = 0.06, kFingerDepth = 0.012, kFingerWidth = 0.022, kTip = 0.012, kClearance = 0.01;
  const Eigen::Vector3d lateral = grasp.lateral();
  double front = 0.0;  // how far the object reaches toward the palm
  for (double along : {-0.03, 0.0, 0.03}) {
    front = std::max(front, reach(object, grasp.centre + along * grasp.closing, grasp.approach));
  }
  const double palm_at = front + kClearance;
  if (front <= 0.0 || palm_at > 0.09) return std::nullopt;
  Hand hand;
  double widest = 0.0;
  for (const double side : {-1.0, 1.0}) {
    double contact = 0.0;
    for (double along = -kTip; along <= palm_at; along += 0.008) {
      for (double across : {-0.01, 0.0, 0.01}) {
        const Eigen::Vector3d target = grasp.centre + along * grasp.approach + across * lateral;
        contact = std::max(contact, reach(object, target, side * grasp.closing));
      }
    }
    if (contact <= 0.0 || contact > kMaxHalfOpening) return std::nullopt;
    widest = std::max(widest, contact);
    const Eigen::Vector3d middle =
        grasp.centre + 0.5 * (palm_at - kTip) * grasp.approach + side * (contact + 0.5 * kFingerDepth) * grasp.closing;
    appendMesh(hand.mesh, makeBox({palm_at + kTip, kFingerDepth, kFingerWidth}),
               poseOfAxes(grasp.approach, grasp.closing, middle));
  }
  constexpr double kPalmLength = 0.06;
  appendMesh(hand.mesh, makeBox({kPalmLength, 2.0 * (widest + kFingerDepth) + 0.01, 0.06}),
             poseOfAxes(grasp.approach, grasp.closing, grasp.centre + (palm_at + 0.5 * kPalmLength) * grasp.approach));
  hand.wrist_out = grasp.approach;
  hand.wrist = grasp.centre + (palm_at + kPalmLength + 0.02) * grasp.approach;
  appendMesh(hand.mesh, makeCapsule(hand.wrist - 0.04 * grasp.approach, hand.wrist, 0.035, 0.042, 16));
  return hand;
}

}  // namespace depth_object_tracker
