// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/robot/joint_state_buffer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace depth_object_tracker {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kTurn = 2.0 * M_PI;

double at(const std::vector<double>& values, std::size_t index) {
  return index < values.size() && std::isfinite(values[index]) ? values[index] : kUnknown;
}

/// Cubic with the given end values and slopes. @param share in [0, 1] of the interval.
double hermite(double from, double to, double slope_from, double slope_to, double interval, double share) {
  const double s = share, s2 = s * s, s3 = s2 * s;
  return (2.0 * s3 - 3.0 * s2 + 1.0) * from + (s3 - 2.0 * s2 + s) * interval * slope_from + (3.0 * s2 - 2.0 * s3) * to +
         (s3 - s2) * interval * slope_to;
}

/// Integral of a value that changes linearly from `begin` to `end`, over the part of [begin_s, end_s] in [from_s,
/// to_s].
double trapezium(double begin_s, double begin, double end_s, double end, double from_s, double to_s) {
  const double low = std::max(begin_s, from_s), high = std::min(end_s, to_s);
  if (high <= low) return 0.0;
  const double slope = end_s > begin_s ? (end - begin) / (end_s - begin_s) : 0.0;
  return (high - low) * (begin + slope * (0.5 * (low + high) - begin_s));
}

double overlap(double begin_s, double end_s, double from_s, double to_s) {
  return std::max(0.0, std::min(end_s, to_s) - std::max(begin_s, from_s));
}

constexpr double kUncoveredS = 1e-6;  // rounding of stamps

}  // namespace

JointStateBuffer::JointStateBuffer(double max_age_s, std::set<std::string> continuous)
    : max_age_s_(max_age_s), continuous_(std::move(continuous)) {}

std::string JointStateBuffer::add(const JointReport& report) {
  const std::size_t count = report.names.size();
  if (!std::isfinite(report.stamp_s) || report.stamp_s <= 0.0) return "it has no stamp";
  const auto fits = [count](const std::vector<double>& values) { return values.empty() || values.size() == count; };
  if (!fits(report.positions) || !fits(report.velocities)) {
    return "it has " + std::to_string(count) + " names but " + std::to_string(report.positions.size()) +
           " positions and " + std::to_string(report.velocities.size()) + " velocities";
  }
  std::string problem;
  const auto is_bad = [](const std::vector<double>& values, std::size_t k) {
    return !values.empty() && !std::isfinite(values[k]);
  };
  for (std::size_t k = 0; k < count; ++k) {
    const std::string& joint = report.names[k];
    if (is_bad(report.positions, k) || is_bad(report.velocities, k)) {
      problem += (problem.empty() ? "a number that is not finite for joint '" : ", '") + joint + "'";
    }
    if (series_.size() >= kMaxJoints && series_.count(joint) == 0) return "there are too many joints";
    const Sample sample{report.stamp_s, at(report.positions, k), at(report.velocities, k)};
    if (std::isfinite(sample.position) || std::isfinite(sample.velocity)) insert(joint, sample);
  }
  return problem;
}

void JointStateBuffer::insert(const std::string& joint, Sample sample) {
  Series& series = series_[joint];
  if (!series.empty() && sample.stamp_s < series.back().stamp_s - kHistoryS) series.clear();
  const auto place = std::lower_bound(series.begin(), series.end(), sample.stamp_s,
                                      [](const Sample& s, double stamp_s) { return s.stamp_s < stamp_s; });
  if (continuous_.count(joint) > 0 && place != series.begin()) {
    const double before = std::prev(place)->position;
    if (std::isfinite(before)) sample.position += kTurn * std::round((before - sample.position) / kTurn);
  }
  if (place != series.end() && place->stamp_s == sample.stamp_s) {
    if (std::isfinite(sample.position)) place->position = sample.position;
    if (std::isfinite(sample.velocity)) place->velocity = sample.velocity;
  } else {
    series.insert(place, sample);
  }
  while (series.size() > kCapacity || series.front().stamp_s < series.back().stamp_s - kHistoryS) series.pop_front();
}

const JointStateBuffer::Series* JointStateBuffer::find(const std::string& joint) const {
  const auto found = series_.find(joint);
  return found == series_.end() || found->second.empty() ? nullptr : &found->second;
}

std::optional<double> JointStateBuffer::newestStamp(const std::string& joint) const {
  const Series* series = find(joint);
  return series ? std::optional<double>(series->back().stamp_s) : std::nullopt;
}

std::vector<std::string> JointStateBuffer::names() const {
  std::vector<std::string> names;
  for (const auto& entry : series_) names.push_back(entry.first);
  return names;
}

std::optional<double> JointStateBuffer::position(const std::string& joint, double stamp_s) const {
  const Series* series = find(joint);
  if (!series) return std::nullopt;
  const auto has_position = [](const Sample& sample) { return std::isfinite(sample.position); };
  auto after = std::lower_bound(series->begin(), series->end(), stamp_s,
                                [](const Sample& s, double stamp) { return s.stamp_s < stamp; });
  const auto before =
      std::find_if(std::make_reverse_iterator(after), std::make_reverse_iterator(series->begin()), has_position);
  const bool has_before = before.base() != series->begin();
  after = std::find_if(after, series->end(), has_position);
  const bool has_after = after != series->end();
  if (has_after && after->stamp_s == stamp_s) return after->position;
  if (has_before && has_after && after->stamp_s - before->stamp_s <= 2.0 * max_age_s_) {
    const double interval_s = after->stamp_s - before->stamp_s;
    const double share = (stamp_s - before->stamp_s) / interval_s;
    if (!std::isfinite(before->velocity) || !std::isfinite(after->velocity)) {
      return before->position + share * (after->position - before->position);
    }
    return hermite(before->position, after->position, before->velocity, after->velocity, interval_s, share);
  }
  if (has_before && stamp_s - before->stamp_s <= max_age_s_) {
    const double velocity = std::isfinite(before->velocity) ? before->velocity : 0.0;
    return before->position + velocity * (stamp_s - before->stamp_s);
  }
  if (has_after && after->stamp_s - stamp_s <= max_age_s_) {
    const double velocity = std::isfinite(after->velocity) ? after->velocity : 0.0;
    return after->position - velocity * (after->stamp_s - stamp_s);
  }
  return std::nullopt;
}

std::optional<double> JointStateBuffer::travel(const std::string& joint, double from_s, double to_s) const {
  const Series* series = find(joint);
  if (!series) return std::nullopt;
  double sum = 0.0, covered_s = 0.0;
  const Sample* previous = nullptr;
  for (const Sample& sample : *series) {
    if (!std::isfinite(sample.velocity)) continue;
    const bool is_joined = previous && sample.stamp_s - previous->stamp_s <= 2.0 * max_age_s_;
    const double begin_s = is_joined ? previous->stamp_s : sample.stamp_s - max_age_s_;
    const double begin = is_joined ? previous->velocity : sample.velocity;
    sum += trapezium(begin_s, begin, sample.stamp_s, sample.velocity, from_s, to_s);
    covered_s += overlap(begin_s, sample.stamp_s, from_s, to_s);
    previous = &sample;
  }
  if (previous) {  // until the next one comes, the newest holds
    const double end_s = previous->stamp_s + max_age_s_;
    sum += trapezium(previous->stamp_s, previous->velocity, end_s, previous->velocity, from_s, to_s);
    covered_s += overlap(previous->stamp_s, end_s, from_s, to_s);
  }
  return covered_s >= to_s - from_s - kUncoveredS ? std::optional<double>(sum) : std::nullopt;
}

std::optional<double> JointStateBuffer::commandedTravel(const std::string& joint, double from_s, double to_s) const {
  const Series* series = find(joint);
  if (!series) return std::nullopt;
  double sum = 0.0, covered_s = 0.0;
  for (auto sample = series->begin(); sample != series->end(); ++sample) {
    if (!std::isfinite(sample->velocity)) continue;
    const auto next = std::next(sample);
    const double ends_s = sample->stamp_s + max_age_s_;
    const double end_s = next == series->end() ? ends_s : std::min(ends_s, next->stamp_s);
    sum += trapezium(sample->stamp_s, sample->velocity, end_s, sample->velocity, from_s, to_s);
    covered_s += overlap(sample->stamp_s, end_s, from_s, to_s);
  }
  return covered_s >= to_s - from_s - kUncoveredS ? std::optional<double>(sum) : std::nullopt;
}

}  // namespace depth_object_tracker
