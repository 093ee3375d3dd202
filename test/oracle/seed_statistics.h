// SPDX-License-Identifier: BSD-3-Clause
// Is the mean over independent seeds the true value? The spread over the seeds gives the tolerance.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace depth_object_tracker {

/// Errors of one estimated quantity, one per seed.
class SeedStatistics {
 public:
  void add(double error) { errors_.push_back(error); }

  double mean() const {
    double sum = 0.0;
    for (const double error : errors_) sum += error;
    return sum / static_cast<double>(errors_.size());
  }

  double standardError() const {
    double squares = 0.0;
    for (const double error : errors_) squares += (error - mean()) * (error - mean());
    const auto count = static_cast<double>(errors_.size());
    return std::sqrt(squares / (count - 1.0) / count);
  }

  /// Mean error in units of its standard error: Student's t with one degree of freedom less than there are seeds.
  double studentT() const { return std::abs(mean()) / std::max(standardError(), 1e-300); }

 private:
  std::vector<double> errors_;
};

}  // namespace depth_object_tracker
