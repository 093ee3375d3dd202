// SPDX-License-Identifier: BSD-3-Clause
// Where the robot's links are and how they moved, from its model and what its joints reported.
#pragma once

#include "depth_object_tracker/robot/joint_state_buffer.h"
#include "depth_object_tracker/robot/robot_model.h"

#include <map>
#include <string>

namespace depth_object_tracker {

/// What the motion of a link between two images is computed from. The configuration always comes from positions.
enum class ControlSource {
  kMeasured,    ///< positions at both ends: the exact integral of the true velocity
  kVelocities,  ///< integral of the reported velocities; of the positions for joints that report none
  kCommands,    ///< integral of the commanded velocities
};

struct RobotStateConfig {
  ControlSource control_source = ControlSource::kMeasured;
  double joint_time_offset_s = 0.0;  ///< the joints' clock minus the camera's: joints are read at image stamp + offset
  double max_joint_age_s = 0.1;      ///< joint data further away from the image than this are stale
};

struct LinkPose {
  Pose T_root_link = Pose::Identity();
  std::string problem;  ///< empty = usable; otherwise names the joints that are missing or stale
};

struct LinkMotion {
  Pose T_root_link_from = Pose::Identity();
  Pose T_root_link_to = Pose::Identity();
  std::string problem;  ///< as above; then both poses mean nothing
};

/// Not thread-safe. Stamps are those of images.
class RobotState {
 public:
  RobotState(RobotModel model, const RobotStateConfig& config);

  /// @return empty, or what is wrong with the report.
  std::string addJointStates(const JointReport& report) { return joints_.add(report); }
  std::string addCommands(const JointReport& report) { return commands_.add(report); }

  /// @param link must exist.
  LinkPose linkPose(const std::string& link, double stamp_s);

  /// Over (from_s, to_s]. @param link must exist.
  LinkMotion linkMotion(const std::string& link, double from_s, double to_s);

  /// True when the joints that `link` depends on have not been reported up to this stamp, but are being reported.
  bool awaitsJoints(const std::string& link, double stamp_s);

  /// Position of any reported joint (a gripper's); nullopt when missing or stale.
  std::optional<double> jointPosition(const std::string& joint, double stamp_s) const;

  /// Time jumped.
  void forget();

  const RobotModel& model() const { return model_; }
  const RobotStateConfig& config() const { return config_; }

 private:
  struct Chain {
    LinkChain chain;
    Eigen::VectorXd positions, displaced;  // scratch
  };
  Chain& chainTo(const std::string& link);
  std::string readPositions(const LinkChain& chain, double joint_time_s, Eigen::VectorXd& positions) const;
  std::string reportedNames() const;
  std::string displace(const LinkChain& chain, double from_s, double to_s, Eigen::VectorXd& positions) const;

  RobotModel model_;
  RobotStateConfig config_;
  JointStateBuffer joints_, commands_;
  std::map<std::string, Chain> chains_;
};

/// @throws std::invalid_argument naming the word and the allowed ones.
ControlSource controlSourceFromName(const std::string& name);

}  // namespace depth_object_tracker
