// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/filter/pose_smoother.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

namespace depth_object_tracker {
namespace {

/// Standard deviations of the acceleration; zero: at rest, without velocity.
struct MotionModel {
  double linear_m_s2, angular_rad_s2;
};
constexpr std::array<MotionModel, 3> kMotions = {{{0.0, 0.0}, {0.5, 3.0}, {5.0, 40.0}}};
constexpr double kChangesPerS = 1.5;  // from one kind of motion to another
// At rest: what grows nevertheless, for errors that last.
constexpr double kRestM = 1.1e-4, kRestRad = 1.1e-3;  // standard deviation after a second
constexpr double kFirstSpeedM = 1.0, kFirstSpeedRad = 4.0;
// The covariance also tells errors that last, which no average takes away, and angles that the image does not show.
constexpr double kMostNoiseM = 1e-3, kMostNoiseRad = 0.0175;
constexpr double kLeastSpeedM = 1e-3, kLeastSpeedRad = 5e-3;  // standard deviation that any velocity has
constexpr double kLongestGapS = 0.5;
constexpr double kJump = 40.0;  // squared Mahalanobis distance
constexpr double kLeastProbability = 1e-6;

/// The noise of one image: the covariance, limited in every direction.
Matrix6d noiseOf(const Matrix6d& covariance) {
  Vector6d unit;
  unit << Eigen::Vector3d::Constant(kMostNoiseM), Eigen::Vector3d::Constant(kMostNoiseRad);
  const Vector6d inverse = unit.cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(inverse.asDiagonal() * covariance * inverse.asDiagonal());
  constexpr double kLeastVariance = 1e-6;
  const Vector6d variances = solver.eigenvalues().cwiseMax(kLeastVariance).cwiseMin(1.0);
  const Matrix6d axes = unit.asDiagonal() * solver.eigenvectors();
  return axes * variances.asDiagonal() * axes.transpose();
}

Vector6d squares(double linear, double angular) {
  Vector6d result;
  result << Eigen::Vector3d::Constant(linear * linear), Eigen::Vector3d::Constant(angular * angular);
  return result;
}

}  // namespace

Pose PoseSmoother::update(const Pose& pose, const Matrix6d& covariance, double dt_s) {
  const Matrix6d noise = noiseOf(covariance);
  if (!is_started_ || !(dt_s > 0.0) || dt_s > kLongestGapS) {
    start(pose, noise);
    return pose;
  }
  mix(dt_s);
  predict(dt_s);
  if (!measure(difference(pose, pose_), noise)) {
    start(pose, noise);
    return pose;
  }
  const Vector6d displacement = mean().head<6>();
  pose_ = perturb(pose_, displacement);
  for (State& state : states_) state.mean.head<6>() -= displacement;
  return pose_;
}

void PoseSmoother::moveCamera(const Pose& T_now_before) {
  if (!is_started_) return;
  pose_ = T_now_before * pose_;
  const Eigen::Matrix3d R = T_now_before.linear();
  Matrix12d turn = Matrix12d::Zero();
  for (int block = 0; block < 12; block += 3) turn.block<3, 3>(block, block) = R;
  for (State& state : states_) {
    state.mean = turn * state.mean;
    state.covariance = turn * state.covariance * turn.transpose();
  }
}

void PoseSmoother::start(const Pose& pose, const Matrix6d& noise) {
  is_started_ = true;
  pose_ = pose;
  probabilities_.fill(1.0 / static_cast<double>(kModels));
  for (std::size_t k = 0; k < kModels; ++k) {
    State& state = states_[k];
    state.mean.setZero();
    state.covariance.setZero();
    state.covariance.topLeftCorner<6, 6>() = noise;
    if (k > 0) state.covariance.bottomRightCorner<6, 6>().diagonal() = squares(kFirstSpeedM, kFirstSpeedRad);
  }
}

/// Each model goes on from what all of them know, by how probably the object changed over from theirs.
void PoseSmoother::mix(double dt_s) {
  const double stays = std::exp(-kChangesPerS * dt_s), changes = (1.0 - stays) / (kModels - 1);
  const std::array<State, kModels> before = states_;
  const std::array<double, kModels> probabilities = probabilities_;
  for (std::size_t to = 0; to < kModels; ++to) {
    std::array<double, kModels> weights;
    double sum = 0.0;
    for (std::size_t from = 0; from < kModels; ++from) {
      weights[from] = probabilities[from] * (from == to ? stays : changes);
      sum += weights[from];
    }
    State& state = states_[to];
    state.mean.setZero();
    for (std::size_t from = 0; from < kModels; ++from) state.mean += weights[from] / sum * before[from].mean;
    state.covariance.setZero();
    for (std::size_t from = 0; from < kModels; ++from) {
      const Vector12d apart = before[from].mean - state.mean;
      state.covariance += weights[from] / sum * (before[from].covariance + apart * apart.transpose());
    }
    probabilities_[to] = sum;
  }
}

void PoseSmoother::predict(double dt_s) {
  State& resting = states_[0];
  resting.mean.tail<6>().setZero();
  resting.covariance.topRightCorner<6, 6>().setZero();
  resting.covariance.bottomRows<6>().setZero();
  resting.covariance.topLeftCorner<6, 6>().diagonal() += dt_s * squares(kRestM, kRestRad);
  Matrix12d transition = Matrix12d::Identity();
  transition.topRightCorner<6, 6>().diagonal().setConstant(dt_s);
  for (std::size_t k = 1; k < kModels; ++k) {
    State& state = states_[k];
    state.mean = transition * state.mean;
    state.covariance = transition * state.covariance * transition.transpose();
    const Vector6d acceleration = squares(kMotions[k].linear_m_s2, kMotions[k].angular_rad_s2);
    const double dt2 = dt_s * dt_s;
    state.covariance.topLeftCorner<6, 6>().diagonal() += 0.25 * dt2 * dt2 * acceleration;
    state.covariance.topRightCorner<6, 6>().diagonal() += 0.5 * dt2 * dt_s * acceleration;
    state.covariance.bottomLeftCorner<6, 6>().diagonal() += 0.5 * dt2 * dt_s * acceleration;
    state.covariance.bottomRightCorner<6, 6>().diagonal() += dt2 * acceleration;
  }
}

bool PoseSmoother::measure(const Vector6d& displacement, const Matrix6d& noise) {
  std::array<double, kModels> log_densities;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < kModels; ++k) {
    State& state = states_[k];
    const Eigen::LLT<Matrix6d> expected(state.covariance.topLeftCorner<6, 6>() + noise);
    const Vector6d surprise = displacement - state.mean.head<6>();
    const double squared = surprise.dot(expected.solve(surprise));
    if (!std::isfinite(squared)) return false;
    least = std::min(least, squared);
    log_densities[k] = -0.5 * squared - expected.matrixLLT().diagonal().array().log().sum();
    const Eigen::Matrix<double, 6, 12> gain = expected.solve(state.covariance.topRows<6>());
    state.mean += gain.transpose() * surprise;
    const Matrix12d reduced = state.covariance - gain.transpose() * state.covariance.topRows<6>();
    state.covariance = 0.5 * (reduced + reduced.transpose());
  }
  if (least > kJump) return false;
  const double largest = *std::max_element(log_densities.begin(), log_densities.end());
  double sum = 0.0;
  for (std::size_t k = 0; k < kModels; ++k) {
    probabilities_[k] = std::max(kLeastProbability, probabilities_[k] * std::exp(log_densities[k] - largest));
    sum += probabilities_[k];
  }
  for (double& probability : probabilities_) probability /= sum;
  return true;
}

PoseSmoother::Vector12d PoseSmoother::mean() const {
  Vector12d mean = Vector12d::Zero();
  for (std::size_t k = 0; k < kModels; ++k) mean += probabilities_[k] * states_[k].mean;
  return mean;
}

Vector6d PoseSmoother::velocity() const {
  return mean().tail<6>();
}

Matrix6d PoseSmoother::velocityCovariance() const {
  const Vector6d middle = velocity();
  Matrix6d covariance = squares(kLeastSpeedM, kLeastSpeedRad).asDiagonal();
  for (std::size_t k = 0; k < kModels; ++k) {
    const Vector6d apart = states_[k].mean.tail<6>() - middle;
    covariance += probabilities_[k] * (states_[k].covariance.bottomRightCorner<6, 6>() + apart * apart.transpose());
  }
  return covariance;
}

}  // namespace depth_object_tracker
