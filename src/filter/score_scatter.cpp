// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/filter/score_scatter.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

constexpr int kLeastBlocks = 4;
constexpr double kMeanOverS = 0.15;
// Few blocks say little about 21 entries: so many blocks' worth of what is expected are added.
constexpr double kExpectedBlocks = 18.0;
// The blocks themselves do not show what is shared by more than one of them.
constexpr double kWiderThanBlocks = 3.0;

Matrix6d squareRoot(const Matrix6d& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(symmetric);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
         eigen.eigenvectors().transpose();
}

Matrix6d inverseOf(const Matrix6d& symmetric) {
  return symmetric.ldlt().solve(Matrix6d::Identity());
}

/// The symmetric matrix M with M from M^T = to: what is spread as `from` becomes spread as `to` with the least motion.
Matrix6d transport(const Matrix6d& from, const Matrix6d& to) {
  const Matrix6d root = squareRoot(from), inverse_root = inverseOf(root);
  return inverse_root * squareRoot(root * to * root) * inverse_root;
}

}  // namespace

void ScoreScatter::add(const Linearisation& block) {
  if (!(block.information.trace() > 0.0)) return;
  information += block.information;
  scatter += block.gradient * block.gradient.transpose();
  ++blocks;
}

void CovarianceCalibration::follow(const ScoreScatter& scores, double dt_s) {
  // A touch of the diagonal: a sphere's turns are not seen at all.
  Matrix6d information = scores.information;
  information.diagonal() *= 1.0 + 1e-6;
  const double ratio = information.ldlt().solve(scores.scatter).trace() / 6.0;
  if (!std::isfinite(ratio) || ratio < 0.0) return;
  const double share = ratio_ > 0.0 ? -std::expm1(-std::max(dt_s, 0.0) / kMeanOverS) : 1.0;
  ratio_ += share * (ratio - ratio_);
}

Matrix6d CovarianceCalibration::calibrated(const Matrix6d& covariance, const ScoreScatter& scores, double exponent,
                                           const Vector6d& prior_variances, double radius_m, double dt_s) {
  if (scores.blocks < kLeastBlocks) return covariance;
  follow(scores, dt_s);
  const double n = scores.blocks;
  const double expected = std::max(1.0 / exponent, kWiderThanBlocks * ratio_);
  const Matrix6d noise =
      (kExpectedBlocks * expected * scores.information + n * n / (n - 1.0) * scores.scatter) / (kExpectedBlocks + n);

  // Rotations as motion of the surface, so that both halves are of one size.
  Vector6d unit = Vector6d::Ones();
  unit.tail<3>().setConstant(radius_m);
  const auto in_units = [&unit](const Matrix6d& m) -> Matrix6d { return unit.asDiagonal() * m * unit.asDiagonal(); };
  const Vector6d inverse_unit = unit.cwiseInverse();
  const Matrix6d prior = prior_variances.cwiseProduct(unit.cwiseAbs2()).cwiseInverse().asDiagonal();
  const Matrix6d information = inverse_unit.asDiagonal() * scores.information * inverse_unit.asDiagonal();
  const Matrix6d noise_in_units = inverse_unit.asDiagonal() * noise * inverse_unit.asDiagonal();
  const Matrix6d as_borne_out = information * noise_in_units.ldlt().solve(information);
  const Matrix6d assumed = exponent * information;
  const Matrix6d change = transport(inverseOf(assumed + prior), inverseOf(as_borne_out + prior));
  const Matrix6d result = change * in_units(covariance) * change.transpose();
  if (!result.allFinite()) return covariance;
  const Matrix6d symmetric = 0.5 * (result + result.transpose());
  return inverse_unit.asDiagonal() * symmetric * inverse_unit.asDiagonal();
}

}  // namespace depth_object_tracker
