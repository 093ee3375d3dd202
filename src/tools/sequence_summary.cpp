// SPDX-License-Identifier: BSD-3-Clause
// Errors, states and times of a whole sequence, and their table.
#include "depth_object_tracker/tools/sequence_summary.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <ostream>

namespace depth_object_tracker {
namespace {

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  char text[200];
  std::snprintf(text, sizeof(text), pattern, values...);
  return text;
}

}  // namespace

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const double position = share * static_cast<double>(values.size() - 1);
  const std::size_t below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (position - static_cast<double>(below)) * (values[above] - values[below]);
}

double areaUnderAccuracyCurve(const std::vector<double>& errors_m, double limit_m) {
  if (errors_m.empty()) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0.0;
  for (const double error_m : errors_m) sum += std::max(0.0, 1.0 - error_m / limit_m);
  return sum / static_cast<double>(errors_m.size());
}

void SequenceSummary::add(const TrackerResult& result, const std::optional<PoseError>& error,
                          std::optional<double> normalised_error_squared, std::optional<double> visible_fraction) {
  has_visibility_ = has_visibility_ || visible_fraction.has_value();
  const bool in_sight = visible_fraction.value_or(1.0) >= kMinVisibleFraction;
  // Before the first frame the object is taken for visible: the tracker is given its pose.
  visible_run_ = in_sight ? visible_run_ + 1 : 0;
  const bool visible_longer =
      visible_run_ >= kVisibleFramesBeforeLoss || visible_run_ > static_cast<int>(frames_.size());
  frames_.push_back({result.state, result.time.total_s, error, normalised_error_squared, error.has_value() && in_sight,
                     visible_longer});
}

SequenceSummary::Losses SequenceSummary::losses() const {
  Losses losses;
  int run = 0;
  const auto end_run = [&] {
    if (run > kLossFrames) {
      ++losses.episodes;
      losses.frames += run;
    }
    run = 0;
  };
  for (const Frame& frame : frames_) {
    if (!frame.error) continue;
    const bool far = (symmetric_ ? frame.error->adds_m : frame.error->add_m) > kLossErrorM;
    if (!far) {
      end_run();
    } else if (frame.judged && frame.visible_longer) {
      ++run;
    }
  }
  end_run();
  return losses;
}

std::vector<double> SequenceSummary::judged(double PoseError::*member) const {
  std::vector<double> values;
  for (const Frame& frame : frames_) {
    if (frame.judged) values.push_back((*frame.error).*member);
  }
  return values;
}

void SequenceSummary::printRow(std::ostream& out, const std::string& name, const std::vector<double>& values,
                               double scale) const {
  out << format("  %-18s %10.3f %10.3f %10.3f\n", name.c_str(), scale * percentile(values, 0.5),
                scale * percentile(values, 0.95), scale * percentile(values, 1.0));
}

void SequenceSummary::printErrors(std::ostream& out) const {
  constexpr double kMillimetres = 1e3;
  constexpr double kDegrees = 180.0 / 3.14159265358979323846;
  const std::vector<double> add = judged(&PoseError::add_m);
  const std::vector<double> adds = judged(&PoseError::adds_m);
  const auto with_truth =
      std::count_if(frames_.begin(), frames_.end(), [](const Frame& f) { return f.error.has_value(); });
  if (with_truth == 0) {
    out << "  no ground truth: no errors\n";
    return;
  }
  if (add.empty()) {
    out << "  no frame with ground truth shows enough of the object: no errors\n";
    return;
  }
  out << "  errors over " << add.size() << " frames"
      << (has_visibility_ ? " with at least 10 % of the object visible" : " with ground truth")
      << (symmetric_ ? "; symmetries folded in translation and rotation" : "") << "\n";
  out << format("  %-18s %10s %10s %10s\n", "", "median", "95 %", "max");
  printRow(out, "ADD [mm]", add, kMillimetres);
  if (symmetric_) printRow(out, "ADD-S [mm]", adds, kMillimetres);
  printRow(out, "translation [mm]", judged(&PoseError::translation_m), kMillimetres);
  printRow(out, "rotation [deg]", judged(&PoseError::rotation_rad), kDegrees);
  out << format("  AUC of ADD, 0 to 10 cm   %.4f\n", areaUnderAccuracyCurve(add));
  if (symmetric_) out << format("  AUC of ADD-S, 0 to 10 cm %.4f\n", areaUnderAccuracyCurve(adds));
  const Losses lost = losses();
  out << "  losses (" << (symmetric_ ? "ADD-S" : "ADD") << " over 5 cm for more than 15 frames): " << lost.episodes
      << ", " << lost.frames << " frames\n";
  printCalibration(out);
}

void SequenceSummary::printCalibration(std::ostream& out) const {
  const double limit = degrees_of_freedom_ == 5 ? 11.0705 : 12.5916;  // 95 % of the chi-square distribution
  std::vector<double> values;
  for (const Frame& frame : frames_) {
    if (frame.judged && frame.normalised_error_squared) values.push_back(*frame.normalised_error_squared);
  }
  if (values.empty()) return;
  const auto inside = std::count_if(values.begin(), values.end(), [limit](double value) { return value <= limit; });
  out << format("  truth inside the 95 %% region: %.1f %% of frames, NEES median %.2f (%d degrees of freedom)\n",
                100.0 * static_cast<double>(inside) / static_cast<double>(values.size()), percentile(values, 0.5),
                degrees_of_freedom_);
}

void SequenceSummary::print(std::ostream& out) const {
  out << "summary\n";
  printErrors(out);
  std::array<int, 5> counts{};
  std::vector<double> times_ms;
  for (const Frame& frame : frames_) {
    ++counts.at(static_cast<std::size_t>(frame.state));
    times_ms.push_back(1e3 * frame.time_s);
  }
  out << "  frames " << frames_.size();
  for (std::size_t i = 0; i < counts.size(); ++i)
    out << ", " << stateName(static_cast<TrackerState>(i)) << ' ' << counts[i];
  out << format("\n  frame time [ms]: median %.2f, 99 %% %.2f, max %.2f\n", percentile(times_ms, 0.5),
                percentile(times_ms, 0.99), percentile(times_ms, 1.0));
}

}  // namespace depth_object_tracker
