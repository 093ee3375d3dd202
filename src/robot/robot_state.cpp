// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/robot/robot_state.h"

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <utility>

namespace depth_object_tracker {
namespace {

constexpr double kLiveJointAgeS = 0.2;  // a stream that is older than this has ended

/// "joint 'a' was never reported, joint 'b' was last reported 0.31 s before the image"
std::string complain(const JointStateBuffer& buffer, const std::string& joint, double stamp_s) {
  const auto newest_s = buffer.newestStamp(joint);
  if (!newest_s) return "joint '" + joint + "' was never reported";
  char text[64];
  const double age_s = stamp_s - *newest_s;
  if (age_s <= buffer.maxAge()) return "joint '" + joint + "' was not reported at the time of the image";
  std::snprintf(text, sizeof(text), "%.2f s before the image", age_s);
  return "joint '" + joint + "' was last reported " + text;
}

void append(std::string& list, const std::string& entry) {
  list += (list.empty() ? "" : ", ") + entry;
}

}  // namespace

RobotState::RobotState(RobotModel model, const RobotStateConfig& config)
    : model_(std::move(model)),
      config_(config),
      joints_(config.max_joint_age_s, model_.continuousJoints()),
      commands_(config.max_joint_age_s) {}

RobotState::Chain& RobotState::chainTo(const std::string& link) {
  const auto found = chains_.find(link);
  if (found != chains_.end()) return found->second;
  LinkChain chain = model_.chainTo(link);
  const Eigen::VectorXd zeros = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(chain.joints().size()));
  return chains_.emplace(link, Chain{std::move(chain), zeros, zeros}).first->second;
}

/// What there is instead, for whoever has got the names wrong.
std::string RobotState::reportedNames() const {
  constexpr std::size_t kEnough = 12;
  const std::vector<std::string> names = joints_.names();
  if (names.empty()) return " (nothing was reported on joint_states)";
  std::string list;
  for (std::size_t k = 0; k < std::min(names.size(), kEnough); ++k) append(list, "'" + names[k] + "'");
  return " (joint_states name " + list + (names.size() > kEnough ? ", ..." : "") + ")";
}

std::string RobotState::readPositions(const LinkChain& chain, double joint_time_s, Eigen::VectorXd& positions) const {
  std::string problem;
  bool is_unheard_of = false;
  for (std::size_t k = 0; k < chain.joints().size(); ++k) {
    const std::string& joint = chain.joints()[k];
    const auto position = joints_.position(joint, joint_time_s);
    if (position) {
      positions[static_cast<Eigen::Index>(k)] = *position;
    } else {
      append(problem, complain(joints_, joint, joint_time_s));
      is_unheard_of = is_unheard_of || !joints_.newestStamp(joint);
    }
  }
  return is_unheard_of ? problem + reportedNames() : problem;
}

/// Adds to the positions at from_s what the chosen velocities make of them until to_s.
std::string RobotState::displace(const LinkChain& chain, double from_s, double to_s, Eigen::VectorXd& positions) const {
  const bool commanded = config_.control_source == ControlSource::kCommands;
  std::string problem;
  for (std::size_t k = 0; k < chain.joints().size(); ++k) {
    const std::string& joint = chain.joints()[k];
    double& position = positions[static_cast<Eigen::Index>(k)];
    const auto travel =
        commanded ? commands_.commandedTravel(joint, from_s, to_s) : joints_.travel(joint, from_s, to_s);
    if (travel) {
      position += *travel;
    } else if (const auto reached = joints_.position(joint, to_s); reached && !commanded) {
      position = *reached;  // no velocities: differentiated positions
    } else {
      append(problem, complain(commanded ? commands_ : joints_, joint, to_s));
    }
  }
  if (!problem.empty() && commanded) problem = "joint_commands: " + problem;
  return problem;
}

LinkPose RobotState::linkPose(const std::string& link, double stamp_s) {
  Chain& entry = chainTo(link);
  LinkPose result;
  result.problem = readPositions(entry.chain, stamp_s + config_.joint_time_offset_s, entry.positions);
  if (result.problem.empty()) result.T_root_link = entry.chain.pose(entry.positions);
  return result;
}

LinkMotion RobotState::linkMotion(const std::string& link, double from_s, double to_s) {
  Chain& entry = chainTo(link);
  const double begin_s = from_s + config_.joint_time_offset_s, end_s = to_s + config_.joint_time_offset_s;
  LinkMotion motion;
  motion.problem = readPositions(entry.chain, begin_s, entry.positions);
  if (!motion.problem.empty()) return motion;
  if (config_.control_source == ControlSource::kMeasured) {
    motion.problem = readPositions(entry.chain, end_s, entry.displaced);
  } else {
    entry.displaced = entry.positions;
    motion.problem = displace(entry.chain, begin_s, end_s, entry.displaced);
  }
  if (!motion.problem.empty()) return motion;
  motion.T_root_link_from = entry.chain.pose(entry.positions);
  motion.T_root_link_to = entry.chain.pose(entry.displaced);
  return motion;
}

bool RobotState::awaitsJoints(const std::string& link, double stamp_s) {
  const double wanted_s = stamp_s + config_.joint_time_offset_s;
  bool awaits = false;
  for (const std::string& joint : chainTo(link).chain.joints()) {
    const auto newest_s = joints_.newestStamp(joint);
    if (!newest_s || *newest_s < wanted_s - kLiveJointAgeS) return false;  // waiting would not help
    awaits = awaits || *newest_s < wanted_s;
  }
  return awaits;
}

std::optional<double> RobotState::jointPosition(const std::string& joint, double stamp_s) const {
  return joints_.position(joint, stamp_s + config_.joint_time_offset_s);
}

void RobotState::forget() {
  joints_.clear();
  commands_.clear();
}

ControlSource controlSourceFromName(const std::string& name) {
  if (name == "measured") return ControlSource::kMeasured;
  if (name == "velocities") return ControlSource::kVelocities;
  if (name == "commands") return ControlSource::kCommands;
  throw std::invalid_argument("control_source is '" + name + "', must be one of: measured, velocities, commands");
}

}  // namespace depth_object_tracker
