// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/fiducials/fiducial_tracker.h"

#include <stdexcept>
#include <utility>

namespace depth_object_tracker {
namespace {

constexpr double kNearestM = 0.05;
constexpr int kMinWindowPx = 32;
constexpr double kWindowMarginPx = 40.0;
constexpr double kWindowMarginShare = 0.3;  // of the object's size in the picture

struct Window {
  int row = 0, col = 0, rows = 0, cols = 0;
};

/// The part of the picture in which all tags lie, with room for motion; empty when some are behind the camera.
Window windowAround(const FiducialMap& map, const Pose& T_view_object, const PinholeCamera& camera,
                    const GrayImageView& image) {
  Eigen::AlignedBox2d box;
  for (const Fiducial& tag : map.tags) {
    for (const Eigen::Vector3d& corner : tag.corners()) {
      const Eigen::Vector3d p_view = T_view_object * corner;
      if (p_view.z() < kNearestM) return {};
      box.extend(camera.project(p_view));
    }
  }
  const Eigen::Vector2d margin = kWindowMarginShare * box.sizes() + Eigen::Vector2d::Constant(kWindowMarginPx);
  const Eigen::Vector2d size(image.width, image.height), zero = Eigen::Vector2d::Zero();
  const Eigen::Vector2i low = (box.min() - margin).cwiseMax(zero).cwiseMin(size).cast<int>();
  const Eigen::Vector2i high = (box.max() + margin).cwiseMax(zero).cwiseMin(size).cast<int>();
  return {low.y(), low.x(), high.y() - low.y(), high.x() - low.x()};
}

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
  points_.clear();
  const auto in_left = detect(left, camera.left, 0.0);
  if (!in_left.empty()) {
    const auto in_right = detect(right, camera.left, camera.baseline_m);
    points_ = triangulateTags(map_, in_left, in_right, camera, config_.noise);
  }
  return update(stamp_s, control);
}

const FiducialEstimate& FiducialTracker::updateRgbd(const GrayImageView& image, const DepthImageView& depth,
                                                    const PinholeCamera& camera, double stamp_s,
                                                    const std::optional<ControlInput>& control) {
  points_ = locateTagsByDepth(map_, detect(image, camera, 0.0), depth, camera, config_.noise);
  return update(stamp_s, control);
}

/// Looks where the object was, in time for the next picture; everywhere when it was not seen there.
std::vector<TagDetection> FiducialTracker::detect(const GrayImageView& image, const PinholeCamera& camera,
                                                  double along_baseline_m) {
  if (estimate_.state != FiducialState::kTracking) return detector_.detect(image);
  const Pose T_view_object = Eigen::Translation3d(-along_baseline_m, 0.0, 0.0) * estimate_.T_camera_object;
  const Window window = windowAround(map_, T_view_object, camera, image);
  if (window.cols < kMinWindowPx || window.rows < kMinWindowPx) return detector_.detect(image);
  GrayImageView part = image;
  part.data += static_cast<std::size_t>(window.row) * image.step + static_cast<std::size_t>(window.col);
  part.width = window.cols;
  part.height = window.rows;
  std::vector<TagDetection> detections = detector_.detect(part);
  for (TagDetection& detection : detections) {
    for (Eigen::Vector2d& corner : detection.corners) corner += Eigen::Vector2d(window.col, window.row);
  }
  return detections;
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
