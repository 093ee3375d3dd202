// SPDX-License-Identifier: BSD-3-Clause
// Errors, states and times of a whole sequence, and their table.
#pragma once

#include "depth_object_tracker/tools/pose_error.h"
#include "depth_object_tracker/tracker/tracker_result.h"

#include <array>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace depth_object_tracker {

/// Linear interpolation between order statistics; NaN for no values.
/// @param share in [0, 1]
double percentile(std::vector<double> values, double share);

/// Area under the curve of (share of frames with an error below x) for x in [0, limit_m], over the limit: [0, 1].
double areaUnderAccuracyCurve(const std::vector<double>& errors_m, double limit_m = 0.1);

class SequenceSummary {
 public:
  static constexpr double kLossErrorM = 0.05;          ///< a frame with a larger error may belong to a loss
  static constexpr int kLossFrames = 15;               ///< more frames than this in a row are a loss
  static constexpr double kMinVisibleFraction = 0.1;   ///< frames with less of the object in sight are not judged
  static constexpr int kVisibleFramesBeforeLoss = 10;  ///< nobody can know where a hidden object went

  /// @param symmetric ADD-S is the error that counts, not ADD.
  /// @param degrees_of_freedom of the normalised errors, 5 or 6.
  SequenceSummary(bool symmetric, int degrees_of_freedom)
      : symmetric_(symmetric), degrees_of_freedom_(degrees_of_freedom) {}

  /// @param error nullopt where there is no ground truth.
  /// @param visible_fraction nullopt where nobody says.
  /// @param normalised_error_squared nullopt where there is none.
  void add(const TrackerResult& result, const std::optional<PoseError>& error,
           std::optional<double> normalised_error_squared, std::optional<double> visible_fraction);

  /// Frames in losses and their number.
  struct Losses {
    int episodes = 0;
    int frames = 0;
  };
  Losses losses() const;

  /// The table that people read.
  void print(std::ostream& out) const;

 private:
  struct Frame {
    TrackerState state;
    double time_s;
    std::optional<PoseError> error;
    std::optional<double> normalised_error_squared;
    bool judged;          // has ground truth and enough of the object in sight
    bool visible_longer;  // in sight for kVisibleFramesBeforeLoss frames
  };

  std::vector<double> judged(double PoseError::*member) const;
  void printErrors(std::ostream& out) const;
  void printRow(std::ostream& out, const std::string& name, const std::vector<double>& values, double scale) const;

  void printCalibration(std::ostream& out) const;

  bool symmetric_;
  int degrees_of_freedom_;
  bool has_visibility_ = false;
  int visible_run_ = 0;
  std::vector<Frame> frames_;
};

}  // namespace depth_object_tracker
