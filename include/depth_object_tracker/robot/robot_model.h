// SPDX-License-Identifier: BSD-3-Clause
// A robot's links and joints from its URDF.
#pragma once

#include "depth_object_tracker/robot/arm_solver.h"
#include "depth_object_tracker/robot/link_chain.h"

#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace urdf {
class ModelInterface;
}

namespace depth_object_tracker {

/// What was read, from where, what is wrong; one sentence, fit for a user.
class RobotModelError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Immutable and cheap to copy; copies may be used by several threads.
class RobotModel {
 public:
  /// @param urdf XML text. @param source where it comes from, for messages.
  /// @throws RobotModelError when it is empty, no XML, no URDF, or holds a joint that mimics itself.
  static RobotModel fromText(const std::string& urdf, const std::string& source);

  /// @param path of a plain .urdf file (xacro is not expanded).
  /// @throws RobotModelError also when the file cannot be read.
  static RobotModel fromFile(const std::string& path);

  const std::string& name() const;
  const std::string& source() const;
  const std::string& rootLink() const;
  bool hasLink(const std::string& link) const;
  std::vector<std::string> linkNames() const;

  /// Joints that turn without end: their positions are good up to whole turns.
  std::set<std::string> continuousJoints() const;

  /// From the root link to `link`.
  /// @throws RobotModelError naming the link, and the nearest names there are.
  LinkChain chainTo(const std::string& link) const;

  /// The same for simulation. Joints that mimic others are taken to be free.
  ArmSolver solverFor(const std::string& link) const;

  /// Visuals, collision shapes, limits.
  const urdf::ModelInterface& description() const;

 private:
  struct Data;
  explicit RobotModel(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  std::shared_ptr<const Data> data_;
};

}  // namespace depth_object_tracker
