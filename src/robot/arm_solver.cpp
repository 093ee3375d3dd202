// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/robot/arm_solver.h"

#include <kdl/chain.hpp>
#include <kdl/chaindynparam.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_lma.hpp>

namespace depth_object_tracker {
namespace {

constexpr double kGravity = 9.81;
constexpr double kToleranceM = 1e-4;
constexpr double kToleranceRad = 1e-3;
constexpr int kMaxIterations = 100;

Vector6d weights() {
  return (Vector6d() << 1.0, 1.0, 1.0, 0.3, 0.3, 0.3).finished();  // a metre counts as some three radians
}

KDL::Frame toFrame(const Pose& pose) {
  KDL::Frame frame;
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) frame.M(row, col) = pose.linear()(row, col);
    frame.p(row) = pose.translation()[row];
  }
  return frame;
}

}  // namespace

struct ArmSolver::Solvers {
  explicit Solvers(const KDL::Chain& given)
      : chain(given),
        forward(chain),
        inverse(chain, weights(), 1e-7, kMaxIterations),
        dynamics(chain, KDL::Vector(0.0, 0.0, -kGravity)),
        in(chain.getNrOfJoints()),
        out(chain.getNrOfJoints()) {}
  KDL::Chain chain;  // the solvers refer to it
  KDL::ChainFkSolverPos_recursive forward;
  KDL::ChainIkSolverPos_LMA inverse;
  KDL::ChainDynParam dynamics;
  KDL::JntArray in, out;
};

ArmSolver::ArmSolver(const KDL::Chain& chain) : solvers_(std::make_unique<Solvers>(chain)) {}
ArmSolver::~ArmSolver() = default;
ArmSolver::ArmSolver(ArmSolver&&) noexcept = default;

std::optional<Eigen::VectorXd> ArmSolver::solve(const Pose& T_root_link, const Eigen::VectorXd& start) {
  const KDL::Frame wanted = toFrame(T_root_link);
  solvers_->in.data = start;
  solvers_->inverse.CartToJnt(solvers_->in, wanted, solvers_->out);
  KDL::Frame reached;
  solvers_->forward.JntToCart(solvers_->out, reached);
  const KDL::Twist error = KDL::diff(reached, wanted);
  if (!(error.vel.Norm() < kToleranceM && error.rot.Norm() < kToleranceRad)) return std::nullopt;
  return solvers_->out.data;
}

Eigen::VectorXd ArmSolver::gravityTorques(const Eigen::VectorXd& positions) {
  solvers_->in.data = positions;
  solvers_->dynamics.JntToGravity(solvers_->in, solvers_->out);
  return solvers_->out.data;
}

}  // namespace depth_object_tracker
