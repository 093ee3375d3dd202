// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/simulator/finger_closer.h"

#include "depth_object_tracker/simulator/ray_cast.h"

#include <cmath>

namespace depth_object_tracker {
namespace {

constexpr double kOpenRad = -0.75;
constexpr double kClosedRad = 1.5;
constexpr double kStepRad = 0.05;
constexpr double kTouchM = 0.011;  // half of a finger's thickness, and a little
const char* const kHandLink = "hand_link";

Eigen::VectorXd jointsOf(const LinkChain& chain, const std::string& joint, double position) {
  Eigen::VectorXd positions = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(chain.joints().size()));
  for (std::size_t k = 0; k < chain.joints().size(); ++k) {
    if (chain.joints()[k] == joint) positions[static_cast<Eigen::Index>(k)] = position;
  }
  return positions;
}

/// One finger at one angle: does it touch, and where.
class Finger {
 public:
  Finger(const RobotModel& model, int number)
      : joint_("finger_" + std::to_string(number) + "_joint"),
        proximal_(model.chainTo("finger_" + std::to_string(number) + "_proximal")),
        distal_(model.chainTo("finger_" + std::to_string(number) + "_distal")),
        side_(number == 3 ? -1.0 : 1.0) {
    const LinkChain hand = model.chainTo(kHandLink);
    T_hand_root_ = hand.pose(jointsOf(hand, "", 0.0)).inverse();
  }
  const std::string& joint() const { return joint_; }

  bool touches(const TriangleMesh& object, const Pose& T_object_hand, double angle) const {
    return linkTouches(proximal_, {0.03, 0.06}, object, T_object_hand, angle) ||
           linkTouches(distal_, {0.02, 0.05}, object, T_object_hand, angle);
  }

 private:
  bool linkTouches(const LinkChain& chain, std::initializer_list<double> along, const TriangleMesh& object,
                   const Pose& T_object_hand, double angle) const {
    const Pose T_object_link = T_object_hand * T_hand_root_ * chain.pose(jointsOf(chain, joint_, angle));
    const Eigen::Vector3d inward = side_ * T_object_link.linear().col(0);
    for (const double z : along) {
      const Eigen::Vector3d p_object = T_object_link * Eigen::Vector3d(0.0, 0.0, z);
      const auto distance = castRay(object, p_object, inward);
      if (distance && *distance < kTouchM) return true;
    }
    return false;
  }

  std::string joint_;
  LinkChain proximal_, distal_;
  double side_;
  Pose T_hand_root_;
};

}  // namespace

std::optional<FingerPositions> closeFingers(const RobotModel& model, const TriangleMesh& object,
                                            const Pose& T_object_hand) {
  FingerPositions positions{{"finger_1_spread", 0.0}};
  for (int number = 1; number <= 3; ++number) {
    const Finger finger(model, number);
    double angle = kOpenRad;
    while (angle < kClosedRad && !finger.touches(object, T_object_hand, angle)) angle += kStepRad;
    if (angle == kOpenRad || angle >= kClosedRad) return std::nullopt;
    positions[finger.joint()] = angle;
  }
  return positions;
}

}  // namespace depth_object_tracker
