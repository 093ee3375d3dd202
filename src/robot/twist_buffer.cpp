// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/robot/twist_buffer.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depth_object_tracker {
namespace {

constexpr double kMinCoveredShare = 0.5;

bool isFinite(const TwistSample& sample) {
  return std::isfinite(sample.stamp_s) && sample.linear_m_s.allFinite() && sample.angular_rad_s.allFinite();
}

struct WeightedSum {
  double duration_s = 0.0;
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();

  void add(const TwistSample& sample, double from_s, double to_s) {
    const double weight = to_s - from_s;
    if (weight <= 0.0) return;
    duration_s += weight;
    linear += weight * sample.linear_m_s;
    angular += weight * sample.angular_rad_s;
  }
};

}  // namespace

bool TwistBuffer::add(const TwistSample& sample) {
  if (!isFinite(sample)) return false;
  if (!samples_.empty() && sample.stamp_s < samples_.back().stamp_s - kHistoryS) samples_.clear();
  const auto position = std::lower_bound(samples_.begin(), samples_.end(), sample.stamp_s,
                                         [](const TwistSample& s, double stamp_s) { return s.stamp_s < stamp_s; });
  if (position != samples_.end() && position->stamp_s == sample.stamp_s) {
    *position = sample;
  } else {
    samples_.insert(position, sample);
  }
  while (samples_.size() > kCapacity || samples_.front().stamp_s < samples_.back().stamp_s - kHistoryS) {
    samples_.pop_front();
  }
  return true;
}

std::optional<TwistSample> TwistBuffer::mean(double from_s, double to_s) const {
  if (from_s >= to_s) from_s = to_s - 1e-6;
  WeightedSum sum;
  double previous_s = -std::numeric_limits<double>::infinity();
  for (const TwistSample& sample : samples_) {
    const double begins_s = std::max(previous_s, sample.stamp_s - max_age_s_);
    sum.add(sample, std::max(begins_s, from_s), std::min(sample.stamp_s, to_s));
    previous_s = sample.stamp_s;
  }
  if (!samples_.empty()) {  // until the next one comes, the newest holds
    sum.add(samples_.back(), std::max(samples_.back().stamp_s, from_s),
            std::min(samples_.back().stamp_s + max_age_s_, to_s));
  }
  if (sum.duration_s < kMinCoveredShare * (to_s - from_s)) return std::nullopt;
  return TwistSample{to_s, sum.linear / sum.duration_s, sum.angular / sum.duration_s};
}

std::optional<double> TwistBuffer::newestStamp() const {
  return samples_.empty() ? std::nullopt : std::optional<double>(samples_.back().stamp_s);
}

}  // namespace depth_object_tracker
