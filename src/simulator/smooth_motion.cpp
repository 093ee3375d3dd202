// SPDX-License-Identifier: BSD-3-Clause
// Band-limited random motion of a rigid body.
#include "depth_object_tracker/simulator/smooth_motion.h"

#include <algorithm>
#include <cmath>

namespace depth_object_tracker {
namespace {

constexpr std::uint64_t kStream = 102;
constexpr double kMinFrequencyHz = 0.12;
constexpr double kMaxFrequencyHz = 0.55;
constexpr double kMaxRate = 20.0;

// Samples of a window: fine for a short scene, coarser for a long one, where the peak is approached often.
double sampleStep(double duration_s) {
  return duration_s > 60.0 ? 0.1 : 1.0 / 60.0;
}

}  // namespace

double SmoothMotion::Signal::at(double progress_s) const {
  double sum = 0.0;
  for (int k = 0; k < kNumSines; ++k) sum += amplitude[k] * std::sin(frequency_rad_s[k] * progress_s + phase[k]);
  return sum;
}

SmoothMotion::SmoothMotion(const SmoothMotionConfig& config, const std::function<bool(const Pose&)>& is_allowed)
    : config_(config), clock_(config.seed, config.first_rest_s) {
  config_.duration_s = std::min(config.duration_s, kMaxWindowS);
  RandomSource random(config.seed, kStream);
  for (Signal& signal : signals_) {
    double sum = 0.0;
    for (int k = 0; k < kNumSines; ++k) {
      // One frequency per band, so that every signal has slow and fast parts.
      const double band = (kMaxFrequencyHz - kMinFrequencyHz) / kNumSines;
      signal.frequency_rad_s[k] = 2.0 * M_PI * (kMinFrequencyHz + band * (k + random.uniform()));
      signal.phase[k] = random.uniform(0.0, 2.0 * M_PI);
      signal.amplitude[k] = random.uniform(0.4, 1.0) / (1.0 + 0.6 * k);
      sum += signal.amplitude[k];
    }
    for (double& amplitude : signal.amplitude) amplitude /= sum;
  }
  chooseRates();
  const auto stays_allowed = [&] {
    for (double t = 0.0; t <= config_.duration_s; t += 4.0 * sampleStep(config_.duration_s)) {
      if (!is_allowed(pose(t))) return false;
    }
    return true;
  };
  while (is_allowed && amplitude_share_ > 0.05 && !stays_allowed()) {
    amplitude_share_ *= 0.85;
    chooseRates();
  }
}

void SmoothMotion::chooseRates() {
  linear_rate_ = rateForPeak(config_.peak_speed_m_s, false);
  angular_rate_ = rateForPeak(config_.peak_speed_rad_s, true);
}

Eigen::Vector3d SmoothMotion::displacement(double progress_s) const {
  return amplitude_share_ * config_.amplitude_m.cwiseProduct(Eigen::Vector3d(
                                signals_[0].at(progress_s), signals_[1].at(progress_s), signals_[2].at(progress_s)));
}

Eigen::Matrix3d SmoothMotion::rotation(double progress_s) const {
  const Eigen::Vector3d vector(signals_[3].at(progress_s), signals_[4].at(progress_s), signals_[5].at(progress_s));
  return expSo3(config_.amplitude_rad * vector) * config_.base_rotation;
}

Pose SmoothMotion::pose(double t_s) {
  const double progress = clock_.progress(t_s);
  Pose pose = Pose::Identity();
  pose.translation() = config_.centre_m + displacement(linear_rate_ * progress);
  pose.linear() = rotation(angular_rate_ * progress);
  return pose;
}

double SmoothMotion::peak(double rate, bool angular) {
  const double step = sampleStep(config_.duration_s);
  constexpr double kDelta = 1e-3;
  double peak = 0.0;
  for (double t = 0.0; t <= config_.duration_s; t += step) {
    const double before = clock_.progress(t), after = clock_.progress(t + kDelta);
    if (after == before) continue;
    const double distance = angular ? logSo3(rotation(rate * after) * rotation(rate * before).transpose()).norm()
                                    : (displacement(rate * after) - displacement(rate * before)).norm();
    peak = std::max(peak, distance / kDelta);
  }
  return peak;
}

double SmoothMotion::rateForPeak(double wanted, bool angular) {
  if (wanted <= 0.0) return 0.0;
  // A faster rate both speeds the motion up and shows more of the path, so the peak grows with it.
  double low = 0.0, high = 1.0;
  while (high < kMaxRate && peak(high, angular) < wanted) high *= 2.0;
  const int iterations = config_.duration_s > 60.0 ? 8 : 12;
  for (int i = 0; i < iterations; ++i) {
    const double middle = 0.5 * (low + high);
    (peak(middle, angular) < wanted ? low : high) = middle;
  }
  return low;
}

}  // namespace depth_object_tracker
