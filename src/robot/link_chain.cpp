// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/robot/link_chain.h"

#include <algorithm>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainfksolvervel_recursive.hpp>

namespace depth_object_tracker {
namespace {

Pose toPose(const KDL::Frame& frame) {
  Pose pose = Pose::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) pose.linear()(row, col) = frame.M(row, col);
    pose.translation()[row] = frame.p(row);
  }
  return pose;
}

}  // namespace

struct LinkChain::Solvers {
  explicit Solvers(const KDL::Chain& given)
      : chain(given),
        positions(chain),
        velocities(chain),
        q(chain.getNrOfJoints()),
        q_and_rate(chain.getNrOfJoints()) {}
  KDL::Chain chain;  // the solvers refer to it
  KDL::ChainFkSolverPos_recursive positions;
  KDL::ChainFkSolverVel_recursive velocities;
  KDL::JntArray q;
  KDL::JntArrayVel q_and_rate;
};

LinkChain::LinkChain(const KDL::Chain& chain, const std::vector<JointRule>& rules)
    : solvers_(std::make_unique<Solvers>(chain)) {
  for (const JointRule& rule : rules) {
    const auto found = std::find(joints_.begin(), joints_.end(), rule.reported);
    sources_.push_back({found - joints_.begin(), rule.multiplier, rule.offset});
    if (found == joints_.end()) joints_.push_back(rule.reported);
  }
}

LinkChain::~LinkChain() = default;
LinkChain::LinkChain(LinkChain&&) noexcept = default;
LinkChain& LinkChain::operator=(LinkChain&&) noexcept = default;

Pose LinkChain::pose(const Eigen::VectorXd& positions) const {
  for (std::size_t k = 0; k < sources_.size(); ++k) {
    const Source& source = sources_[k];
    solvers_->q(static_cast<unsigned>(k)) = source.multiplier * positions[source.joint] + source.offset;
  }
  KDL::Frame frame;
  solvers_->positions.JntToCart(solvers_->q, frame);
  return toPose(frame);
}

Vector6d LinkChain::twist(const Eigen::VectorXd& positions, const Eigen::VectorXd& velocities) const {
  for (std::size_t k = 0; k < sources_.size(); ++k) {
    const Source& source = sources_[k];
    const auto index = static_cast<unsigned>(k);
    solvers_->q_and_rate.q(index) = source.multiplier * positions[source.joint] + source.offset;
    solvers_->q_and_rate.qdot(index) = source.multiplier * velocities[source.joint];
  }
  KDL::FrameVel frame;
  solvers_->velocities.JntToCart(solvers_->q_and_rate, frame);
  Vector6d twist;
  for (int k = 0; k < 3; ++k) {
    twist[k] = frame.p.v(k);
    twist[k + 3] = frame.M.w(k);
  }
  return twist;
}

}  // namespace depth_object_tracker
