// SPDX-License-Identifier: BSD-3-Clause
// Forward kinematics from the robot's root to one link.
#pragma once

#include "depth_object_tracker/geometry/pose.h"

#include <memory>
#include <string>
#include <vector>

namespace KDL {
class Chain;
}

namespace depth_object_tracker {

/// How a joint of the URDF follows from what the robot reports: position = multiplier * reported + offset. Other than
/// the identity for joints that mimic another.
struct JointRule {
  std::string reported;  ///< name in sensor_msgs/JointState
  double multiplier = 1.0;
  double offset = 0.0;
};

/// Not thread-safe: the solvers have scratch memory. Does not allocate after construction.
class LinkChain {
 public:
  /// @param rules one per moving joint of the chain, from the root on.
  LinkChain(const KDL::Chain& chain, const std::vector<JointRule>& rules);
  ~LinkChain();
  LinkChain(LinkChain&&) noexcept;
  LinkChain& operator=(LinkChain&&) noexcept;

  /// Reported joints that the pose depends on, each once; positions and velocities below are in this order.
  const std::vector<std::string>& joints() const { return joints_; }

  /// T_root_link. @param positions [rad or m], one per joint.
  Pose pose(const Eigen::VectorXd& positions) const;

  /// Velocity of the link's origin [m/s] and its angular velocity [rad/s], axes of the root link.
  Vector6d twist(const Eigen::VectorXd& positions, const Eigen::VectorXd& velocities) const;

 private:
  struct Solvers;
  struct Source {
    Eigen::Index joint;  // in joints_
    double multiplier, offset;
  };
  std::vector<std::string> joints_;
  std::vector<Source> sources_;
  std::unique_ptr<Solvers> solvers_;
};

}  // namespace depth_object_tracker
