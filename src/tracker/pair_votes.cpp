// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/pair_votes.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

constexpr int kTurns = 30;
constexpr double kTurnsPerRad = kTurns / (2.0 * M_PI);
// Pairs on a plane are alike by the hundred and say little: no more of them vote.
constexpr std::ptrdiff_t kMostAlike = 100;
constexpr float kLeastVotes = 3.0f;

}  // namespace

PairVotes::PairVotes(const PointPairs& pairs) : pairs_(&pairs) {
  for (const OrientedPoint& point : pairs.points()) axes_object_.push_back(axesOf(point));
  votes_.resize(axes_object_.size() * kTurns);
}

void PairVotes::start(const OrientedPoint& reference) {
  reference_ = reference;
  axes_reference_ = axesOf(reference);
  std::fill(votes_.begin(), votes_.end(), 0.0f);
}

void PairVotes::vote(const OrientedPoint& other, const std::array<double, 4>& jitter, double choice) {
  const auto [begin, end] = pairs_->alike(reference_, other, jitter);
  if (begin == end) return;
  const double turn = turnAbout(axes_reference_, reference_, other);
  const std::ptrdiff_t count = end - begin, voting = std::min(count, kMostAlike);
  const auto first = static_cast<std::ptrdiff_t>(choice * static_cast<double>(count));
  for (std::ptrdiff_t i = 0; i < voting; ++i) {
    const PointPairs::Entry& entry = begin[(first + i * count / voting) % count];
    const double cell = (turn - static_cast<double>(entry.turn_rad)) * kTurnsPerRad + 2.0 * kTurns;
    const int lower = static_cast<int>(cell);
    const auto share = static_cast<float>(cell - lower);
    float* row = &votes_[static_cast<std::size_t>(entry.first) * kTurns];
    row[lower % kTurns] += 1.0f - share;
    row[(lower + 1) % kTurns] += share;
  }
}

void PairVotes::bestPoses(int count, std::vector<Pose>& poses) {
  peaks_.clear();
  for (std::size_t point = 0; point < axes_object_.size(); ++point) {
    const float* row = &votes_[point * kTurns];
    for (int turn = 0; turn < kTurns; ++turn) {
      const float here = row[turn];
      if (here < kLeastVotes || here < row[(turn + 1) % kTurns] || here < row[(turn + kTurns - 1) % kTurns]) continue;
      peaks_.push_back({here, point, turn});
    }
  }
  const auto kept = peaks_.begin() + std::min<std::ptrdiff_t>(count, static_cast<std::ptrdiff_t>(peaks_.size()));
  std::partial_sort(peaks_.begin(), kept, peaks_.end(), [](const Peak& a, const Peak& b) {
    return a.votes > b.votes || (a.votes == b.votes && (a.point < b.point || (a.point == b.point && a.turn < b.turn)));
  });
  for (auto peak = peaks_.begin(); peak != kept; ++peak) {
    Pose pose = Pose::Identity();
    pose.linear() = axes_reference_ *
                    Eigen::AngleAxisd(peak->turn / kTurnsPerRad, Eigen::Vector3d::UnitX()).toRotationMatrix() *
                    axes_object_[peak->point].transpose();
    pose.translation() = reference_.point - pose.linear() * pairs_->points()[peak->point].point;
    poses.push_back(pose);
  }
}

}  // namespace depth_object_tracker
