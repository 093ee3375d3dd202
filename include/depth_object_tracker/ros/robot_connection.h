// SPDX-License-Identifier: BSD-3-Clause
// The robot as the tracker sees it: joint states and commands in, links in the camera's frame out.
#pragma once

#include "depth_object_tracker/model/control_input.h"
#include "depth_object_tracker/robot/robot_state.h"

#include <sensor_msgs/JointState.h>
#include <tf2/buffer_core.h>

#include <optional>
#include <string>

namespace depth_object_tracker {

enum class CameraPoseSource {
  kTf,    ///< tf at the stamp of the image: any camera, moving or not
  kUrdf,  ///< the camera's frame is a link of the URDF, placed by the joints
};

struct RobotConnectionConfig {
  RobotStateConfig state;
  CameraPoseSource camera_pose_source = CameraPoseSource::kTf;
  std::string base_frame;  ///< tf's name for the URDF's root link; empty = the same name
};

/// A link in the camera's optical frame, or why that is not known.
struct LinkInCamera {
  Pose T_camera_link = Pose::Identity();
  std::string problem;
};

/// How the robot moves what it holds. With a problem `control` says "held, motion unknown".
struct HandControl {
  ControlInput control;
  std::string problem;
};

/// Belongs to the tracker's thread.
class RobotConnection {
 public:
  /// @param tf outlives this object.
  RobotConnection(RobotModel model, const RobotConnectionConfig& config, const tf2::BufferCore& tf);

  /// @return empty, or why (a part of) the message is ignored.
  std::string addJointStates(const sensor_msgs::JointState& message);
  std::string addCommands(const sensor_msgs::JointState& message);

  /// @return empty, or that the robot has no such link, with the names that there are.
  std::string findLinkProblem(const std::string& link) const;

  /// Motion of an object held by `link` over (from_s, to_s]. @param link must exist.
  /// @param T_camera_object where it was at from_s.
  /// @param T_now_before what the tracker itself has done about a camera that moves in its fixed frame: from the camera
  ///   of from_s to that of to_s. Identity: the camera's own motion is part of the control.
  HandControl control(const std::string& link, const std::string& camera_frame, double from_s, double to_s,
                      const Pose& T_camera_object, const Pose& T_now_before = Pose::Identity());

  /// @param link must exist.
  LinkInCamera locate(const std::string& link, const std::string& camera_frame, double stamp_s);

  /// True when joints or tf up to this stamp are not here yet but may well come.
  bool awaits(const std::string& link, const std::string& camera_frame, double stamp_s);

  std::optional<double> jointPosition(const std::string& joint, double stamp_s) const {
    return state_.jointPosition(joint, stamp_s);
  }

  /// Time jumped.
  void forget() { state_.forget(); }

  const RobotModel& model() const { return state_.model(); }
  RobotState& state() { return state_; }

  /// Pose of the URDF's root link in the camera at a stamp.
  LinkInCamera locateRoot(const std::string& camera_frame, double stamp_s);

 private:
  const std::string& baseFrame() const;

  RobotState state_;
  RobotConnectionConfig config_;
  const tf2::BufferCore& tf_;
};

/// @throws std::invalid_argument naming the word and the allowed ones.
CameraPoseSource cameraPoseSourceFromName(const std::string& name);

}  // namespace depth_object_tracker
