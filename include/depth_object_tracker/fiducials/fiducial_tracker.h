// SPDX-License-Identifier: BSD-3-Clause
// Tracks an object by the AprilTags on it: the paper's comparison method.
#pragma once

#include "depth_object_tracker/fiducials/fiducial_pose.h"
#include "depth_object_tracker/fiducials/pose_kalman_filter.h"

#include <optional>
#include <string>

namespace depth_object_tracker {

struct FiducialTrackerConfig {
  FiducialNoise noise;
  PoseKalmanConfig filter;
  double max_rms_m = 0.01;    ///< tags that fit one pose worse than this are left out
  double lost_after_s = 1.0;  ///< without a tag; then the first tag seen starts anew
  int num_threads = 1;        ///< of the detector
};

enum class FiducialState {
  kUninitialized,  ///< no tag has been seen yet
  kTracking,       ///< tags are seen
  kHidden,         ///< none is seen: predicted only
  kLost,           ///< none has been seen for long: there is no pose
};
const char* fiducialStateName(FiducialState state);

struct FiducialEstimate {
  FiducialState state = FiducialState::kUninitialized;
  Pose T_camera_object = Pose::Identity();  ///< in the left (or only) camera
  Matrix6d covariance = Matrix6d::Identity();
  int num_tags = 0;  ///< used in this picture
  bool hasPose() const { return state == FiducialState::kTracking || state == FiducialState::kHidden; }
};

/// Not thread-safe.
class FiducialTracker {
 public:
  /// @throws std::invalid_argument for an unknown family or a map without tags.
  FiducialTracker(FiducialMap map, const FiducialTrackerConfig& config);

  /// Where to start before the first tag is seen. Optional. @param covariance of the mesh origin's pose.
  void initialise(const Pose& T_camera_object, const Matrix6d& covariance);

  /// @param stamp_s an earlier one than before starts anew.
  /// @param control mean motion of the object since the last picture, axes of the left camera.
  const FiducialEstimate& updateStereo(const GrayImageView& left, const GrayImageView& right,
                                       const StereoCamera& camera, double stamp_s,
                                       const std::optional<ControlInput>& control = std::nullopt);

  /// The same with depth registered to the picture, of the same size.
  const FiducialEstimate& updateRgbd(const GrayImageView& image, const DepthImageView& depth,
                                     const PinholeCamera& camera, double stamp_s,
                                     const std::optional<ControlInput>& control = std::nullopt);

  const FiducialEstimate& estimate() const { return estimate_; }
  /// Corners used last.
  const std::vector<FiducialPoint>& points() const { return points_; }

 private:
  std::vector<TagDetection> detect(const GrayImageView& image, const PinholeCamera& camera, double along_baseline_m);
  const FiducialEstimate& update(double stamp_s, const std::optional<ControlInput>& control);
  void measure(const FiducialPose& measured, double stamp_s);

  FiducialMap map_;
  FiducialTrackerConfig config_;
  TagDetector detector_;
  PoseKalmanFilter filter_;
  std::vector<FiducialPoint> points_;
  FiducialEstimate estimate_;
  std::optional<double> last_stamp_s_, last_seen_s_;
};

}  // namespace depth_object_tracker
