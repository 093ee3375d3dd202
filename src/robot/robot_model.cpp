// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/robot/robot_model.h"

#include "depth_object_tracker/geometry/file_access.h"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <kdl/tree.hpp>
#include <kdl_parser/kdl_parser.hpp>
#include <mutex>

namespace depth_object_tracker {
namespace {

constexpr std::uintmax_t kMaxFileBytes = 16 << 20;
constexpr int kMaxMimicDepth = 32;  // deeper is a circle

/// Collects what the parser complains about, which it only logs.
class ComplaintCollector : public console_bridge::OutputHandler {
 public:
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_WARN) return;
    complaints_ += (complaints_.empty() ? "" : "; ") + text;
  }
  const std::string& complaints() const { return complaints_; }

 private:
  std::string complaints_;
};

urdf::ModelInterfaceSharedPtr parse(const std::string& text, std::string& complaints) {
  static std::mutex mutex;  // the parser's log handler is the process's
  const std::lock_guard<std::mutex> lock(mutex);
  ComplaintCollector collector;
  console_bridge::useOutputHandler(&collector);
  urdf::ModelInterfaceSharedPtr model;
  try {
    model = urdf::parseURDF(text);
  } catch (const std::exception& error) {
    complaints = error.what();
  }
  console_bridge::restorePreviousOutputHandler();
  complaints += collector.complaints();
  return model;
}

bool isMoving(const urdf::Joint& joint) {
  return joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS ||
         joint.type == urdf::Joint::PRISMATIC;
}

std::string quoted(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "'" : ", '") + name + "'";
  return text;
}

}  // namespace

struct RobotModel::Data {
  std::string source;
  std::string root;
  urdf::ModelInterfaceSharedPtr urdf;
  KDL::Tree tree;

  JointRule ruleFor(const std::string& joint_name) const;
  KDL::Chain chainTo(const std::string& link) const;
};

/// Follows the joints that this one mimics to the one that the robot reports.
JointRule RobotModel::Data::ruleFor(const std::string& joint_name) const {
  JointRule rule{joint_name, 1.0, 0.0};
  for (int depth = 0; depth < kMaxMimicDepth; ++depth) {
    const auto joint = urdf->getJoint(rule.reported);
    if (!joint) {
      throw RobotModelError("robot model from '" + source + "': joint '" + joint_name + "' mimics joint '" +
                            rule.reported + "', which does not exist");
    }
    if (!joint->mimic) return rule;
    rule.offset += rule.multiplier * joint->mimic->offset;
    rule.multiplier *= joint->mimic->multiplier;
    rule.reported = joint->mimic->joint_name;
  }
  throw RobotModelError("robot model from '" + source + "': joint '" + joint_name + "' mimics itself");
}

RobotModel RobotModel::fromText(const std::string& urdf, const std::string& source) {
  const std::string what = "robot model from '" + source + "' ";
  if (urdf.find_first_not_of(" \t\r\n") == std::string::npos) throw RobotModelError(what + "is empty");
  if (urdf.find("http://www.ros.org/wiki/xacro") != std::string::npos && urdf.find("xacro:") != std::string::npos) {
    throw RobotModelError(what + "is a xacro file; expand it to plain URDF first");
  }
  auto data = std::make_shared<Data>();
  data->source = source;
  std::string complaints;
  data->urdf = parse(urdf, complaints);
  if (!data->urdf || !data->urdf->getRoot()) {
    throw RobotModelError(what + "is not a URDF that can be used" + (complaints.empty() ? "" : ": " + complaints));
  }
  data->root = data->urdf->getRoot()->name;
  if (!kdl_parser::treeFromUrdfModel(*data->urdf, data->tree)) {
    throw RobotModelError(what + "has no kinematic tree that can be used");
  }
  for (const auto& entry : data->urdf->links_) {  // joints in a circle are parsed, and hang in the air
    if (data->tree.getSegments().count(entry.first) > 0) continue;
    for (const auto& other : data->urdf->links_) other.second->child_links.clear();  // or they keep each other for ever
    throw RobotModelError(what + "does not connect link '" + entry.first + "' with its root '" + data->root + "'");
  }
  for (const auto& [name, joint] : data->urdf->joints_) {
    if (isMoving(*joint)) data->ruleFor(name);  // throws what is wrong with it
  }
  return RobotModel(std::move(data));
}

RobotModel RobotModel::fromFile(const std::string& path) {
  std::string text;
  try {
    text = InputFile(path, kMaxFileBytes).read();
  } catch (const FileError& error) {
    throw RobotModelError("robot model '" + path + "' cannot be read; check the path: " + error.what());
  }
  return fromText(text, path);
}

const std::string& RobotModel::name() const {
  return data_->urdf->getName();
}
const std::string& RobotModel::source() const {
  return data_->source;
}
const std::string& RobotModel::rootLink() const {
  return data_->root;
}
bool RobotModel::hasLink(const std::string& link) const {
  return data_->urdf->links_.count(link) > 0;
}
const urdf::ModelInterface& RobotModel::description() const {
  return *data_->urdf;
}

std::vector<std::string> RobotModel::linkNames() const {
  std::vector<std::string> names;
  for (const auto& entry : data_->urdf->links_) names.push_back(entry.first);
  return names;
}

std::set<std::string> RobotModel::continuousJoints() const {
  std::set<std::string> names;
  for (const auto& [name, joint] : data_->urdf->joints_) {
    if (joint->type == urdf::Joint::CONTINUOUS) names.insert(name);
  }
  return names;
}

KDL::Chain RobotModel::Data::chainTo(const std::string& link) const {
  KDL::Chain chain;
  if (urdf->links_.count(link) > 0 && tree.getChain(root, link, chain)) return chain;
  std::vector<std::string> names;
  for (const auto& entry : urdf->links_) names.push_back(entry.first);
  throw RobotModelError("robot '" + urdf->getName() + "' (from '" + source + "') has no link '" + link +
                        "'; its links are " + quoted(names));
}

ArmSolver RobotModel::solverFor(const std::string& link) const {
  return ArmSolver(data_->chainTo(link));
}

LinkChain RobotModel::chainTo(const std::string& link) const {
  const KDL::Chain chain = data_->chainTo(link);
  std::vector<JointRule> rules;
  for (const KDL::Segment& segment : chain.segments) {
    const KDL::Joint& joint = segment.getJoint();
    if (joint.getType() != KDL::Joint::None) rules.push_back(data_->ruleFor(joint.getName()));
  }
  return LinkChain(chain, rules);
}

}  // namespace depth_object_tracker
