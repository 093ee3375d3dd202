// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/fiducials/fiducial_tracker.h"

#include <stdexcept>
#include <utility>

namespace depth_object_tracker {
namespace {

FiducialMap checked(FiducialMap map) {
  if (map.tags.empty()) throw std::invalid_argument("the object carries no tag");
  for (const Fiducial& tag : map.tags) drawTag(map.family, tag.id);
  return map;
}

}  // namespace

const char* fiducialStateName(FiducialState state) {
  switch (state) {
    case FiducialState::kTracking:
      return "TRACKING";
    case FiducialState::kHidden:
      return "OCCLUDED";
    case FiducialState::kLost:
      return "LOST";
    default:
      return "UNINITIALIZED";
  }
}

FiducialTracker::FiducialTracker(FiducialMap map, const FiducialTrackerConfig& config)
    : map_(checked(std::move(map))),
      config_(config),
      detector_(map_.family, config.num_threads),
      filter_(config.filter, map_.centre()) {}

void FiducialTracker::initialise(const Pose& T_camera_object, const Matrix6d& covariance) {
  filter_.initialise(T_camera_object, covariance);
  last_stamp_s_.reset();
  last_seen_s_.reset();
  estimate_.state = FiducialState::kHidden;
}

const FiducialEstimate& FiducialTracker::updateStereo(const GrayImageView& left, const GrayImageView& right,
                                                      const StereoCamera& camera, double stamp_s,
                                                      const std::optional<ControlInput>& control) {
  const auto in_left = detector_.detect(left);
  points_ = in_left.empty() ? std::vector<FiducialPoint>()
                            : triangulateTags(map_, in_left, detector_.detect(right), camera, config_.noise);
  return update(stamp_s, control);
}

const FiducialEstimate& FiducialTracker::updateRgbd(const GrayImageView& image, const DepthImageView& depth,
                                                    const PinholeCamera& camera, double stamp_s,
                                                    const std::optional<ControlInput>& control) {
  points_ = locateTagsByDepth(map_, detector_.detect(image), depth, camera, config_.noise);
  return update(stamp_s, control);
}

const FiducialEstimate& FiducialTracker::update(double stamp_s, const std::optional<ControlInput>& control) {
  if (last_stamp_s_ && stamp_s < *last_stamp_s_) {  // time jumped back: what was known is of another time
    last_seen_s_.reset();
    estimate_ = FiducialEstimate();
  }
  if (estimate_.hasPose() && last_stamp_s_) filter_.predict(stamp_s - *last_stamp_s_, control);
  last_stamp_s_ = stamp_s;
  if (!last_seen_s_) last_seen_s_ = stamp_s;
  estimate_.num_tags = 0;
  if (const auto measured = fitFiducialPose(points_, config_.max_rms_m)) measure(*measured, stamp_s);
  if (estimate_.hasPose()) {
    estimate_.state = estimate_.num_tags > 0 ? FiducialState::kTracking : FiducialState::kHidden;
    if (stamp_s - *last_seen_s_ > config_.lost_after_s) estimate_.state = FiducialState::kLost;
    estimate_.T_camera_object = filter_.pose();
    estimate_.covariance = filter_.covariance();
  }
  return estimate_;
}

void FiducialTracker::measure(const FiducialPose& measured, double stamp_s) {
  if (!estimate_.hasPose()) {
    filter_.initialise(measured.T_camera_object, measured.covariance);
    estimate_.state = FiducialState::kTracking;
  } else if (!filter_.update(measured.T_camera_object, measured.covariance)) {
    return;
  }
  estimate_.num_tags = measured.num_tags;
  last_seen_s_ = stamp_s;
}

}  // namespace depth_object_tracker
