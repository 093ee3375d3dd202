// SPDX-License-Identifier: BSD-3-Clause
// Inverse kinematics and gravity of a chain, for simulation.
#pragma once

#include "depth_object_tracker/geometry/pose.h"

#include <memory>
#include <optional>

namespace KDL {
class Chain;
}

namespace depth_object_tracker {

/// For chains without mimic joints. Not thread-safe.
class ArmSolver {
 public:
  explicit ArmSolver(const KDL::Chain& chain);
  ~ArmSolver();
  ArmSolver(ArmSolver&&) noexcept;

  /// Joint positions near `start` that bring the link to a pose, by Levenberg-Marquardt.
  /// @return nullopt when it cannot be reached to 0.1 mm and 1 mrad.
  std::optional<Eigen::VectorXd> solve(const Pose& T_root_link, const Eigen::VectorXd& start);

  /// Torques [Nm] that hold the links' weight. The root link's z axis points up.
  Eigen::VectorXd gravityTorques(const Eigen::VectorXd& positions);

 private:
  struct Solvers;
  std::unique_ptr<Solvers> solvers_;
};

}  // namespace depth_object_tracker
