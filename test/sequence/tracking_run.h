// SPDX-License-Identifier: BSD-3-Clause
// A tracker that follows a scripted scene frame by frame and remembers how well.
#pragma once

#include "scripted_scene.h"

#include <cstdio>
#include <string>
#include <vector>

namespace depth_object_tracker {

class TrackingRun {
 public:
  static constexpr double kFrameS = 1.0 / 30.0;

  /// Starts at `first` made wrong by a few millimetres and degrees, as a person would.
  TrackingRun(ScriptedScene& scene, const Pose& first, const TrackerConfig& config = TrackerConfig())
      : scene_(scene), tracker_(scene.object(), config) {
    tracker_.initialise(movedBy(first, 0.004, -0.003, 0.004, {0.03, -0.04, 0.02}));
  }

  void setEffort(double effort) { tracker_.setEffort(effort); }

  /// One frame `dt_s` after the last one.
  const TrackerResult& step(const std::optional<Pose>& truth, const std::optional<Board>& board = std::nullopt,
                            double dt_s = kFrameS) {
    return stepWithImage(scene_.render(truth, board), truth, dt_s);
  }

  const TrackerResult& stepWithImage(const std::vector<std::uint16_t>& image, const std::optional<Pose>& truth,
                                     double dt_s = kFrameS) {
    stamp_s_ += dt_s;
    result_ = tracker_.update(scene_.view(image), scene_.camera(), stamp_s_);
    if (truth) {
      last_error_m_ = scene_.error(result_.T_camera_object, *truth);
      errors_m_.push_back(last_error_m_);
    }
    lost_frames_ += result_.state == TrackerState::kLost ? 1 : 0;
    return result_;
  }

  /// As many frames of an object at rest.
  void rest(const Pose& truth, int frames, const std::optional<Board>& board = std::nullopt) {
    for (int k = 0; k < frames; ++k) step(truth, board);
  }

  /// Forgets the errors so far: what comes is judged.
  void startJudging() {
    errors_m_.clear();
    lost_frames_ = 0;
  }

  double medianError() const { return median(errors_m_); }
  double largestError() const {
    double largest = 0.0;
    for (const double error : errors_m_) largest = std::max(largest, error);
    return largest;
  }
  double lastError() const { return last_error_m_; }
  int lostFrames() const { return lost_frames_; }
  const TrackerResult& result() const { return result_; }
  ObjectTracker& tracker() { return tracker_; }
  double stamp() const { return stamp_s_; }

  void print(const char* what) const {
    std::printf("%s: ADD median %.2f mm, largest %.2f mm, %d frames lost\n", what, 1e3 * medianError(),
                1e3 * largestError(), lost_frames_);
  }

 private:
  ScriptedScene& scene_;
  ObjectTracker tracker_;
  double stamp_s_ = 100.0;
  TrackerResult result_;
  std::vector<double> errors_m_;
  double last_error_m_ = 0.0;
  int lost_frames_ = 0;
};

}  // namespace depth_object_tracker
