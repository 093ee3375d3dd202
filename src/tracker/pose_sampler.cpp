// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/pose_sampler.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>

namespace depth_object_tracker {
namespace {

constexpr std::array<double, 6> kWidthsM = {0.003, 0.002, 0.001, 0.0, 0.0, 0.0};  // a round each
constexpr int kDraws = 60;
constexpr std::size_t kKept = 10;
constexpr double kSpread = 0.9, kLeastShare = 1e-4;  // of a draw about one that is kept; of the first variances

}  // namespace

std::uint64_t PoseSampler::numDraws() {
  return kWidthsM.size() * kDraws;
}

Pose PoseSampler::highest(const Pose& middle, const Vector6d& variances, const Value& value, const Climb& climb,
                          std::uint64_t first_draw) {
  samples_.clear();
  Matrix6d root = Vector6d(variances.cwiseSqrt()).asDiagonal();
  for (const double width_m : kWidthsM) {
    drawAbout(middle, root, first_draw);
    first_draw += kDraws;
    valueAll(value, width_m);
    samples_.resize(kKept);
    root = kSpread * rootOfScatter(kLeastShare * variances);
  }
  climbAll(climb);
  valueAll(value, 0.0);
  return samples_.front().pose;
}

/// About the samples in turn, as they are spread among themselves; where there are none yet, about the middle.
void PoseSampler::drawAbout(const Pose& middle, const Matrix6d& root, std::uint64_t first_draw) {
  const std::size_t known = samples_.size();
  for (std::uint64_t draw = 0; draw < kDraws; ++draw) {
    const Pose& about = known == 0 ? middle : samples_[draw % known].pose;
    samples_.push_back({perturb(about, root * random_.normal6(RandomPurpose::kSearch, first_draw + draw, 0)), 0.0});
  }
}

/// Highest first.
void PoseSampler::valueAll(const Value& value, double width_m) {
  const auto task = [&](int index, int thread) {
    Sample& sample = samples_[static_cast<std::size_t>(index)];
    sample.value = value(sample.pose, width_m, thread);
  };
  pool_.run(static_cast<int>(samples_.size()), std::cref(task));
  std::stable_sort(samples_.begin(), samples_.end(),
                   [](const Sample& a, const Sample& b) { return a.value > b.value; });
}

Matrix6d PoseSampler::rootOfScatter(const Vector6d& least_variances) const {
  const auto count = static_cast<double>(samples_.size());
  const Pose& chart = samples_.front().pose;
  Vector6d mean = Vector6d::Zero();
  for (const Sample& sample : samples_) mean += difference(sample.pose, chart) / count;
  Matrix6d scatter = least_variances.asDiagonal();
  for (const Sample& sample : samples_) {
    const Vector6d apart = difference(sample.pose, chart) - mean;
    scatter += apart * apart.transpose() / count;
  }
  return scatter.llt().matrixL();
}

/// Appends the tops.
void PoseSampler::climbAll(const Climb& climb) {
  const std::size_t count = samples_.size();
  samples_.resize(2 * count);
  const auto task = [&](int index, int thread) {
    const auto i = static_cast<std::size_t>(index);
    samples_[count + i].pose = climb(samples_[i].pose, thread);
  };
  pool_.run(static_cast<int>(count), std::cref(task));
}

}  // namespace depth_object_tracker
