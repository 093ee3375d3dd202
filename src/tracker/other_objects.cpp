// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/other_objects.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace depth_object_tracker {
namespace {

constexpr double kFarthestS = 0.2;  // a missed image or a few
constexpr double kSeenScore = 0.7, kSeenVisibleFraction = 0.1, kSeenStddevM = 0.004;

void mergeNearest(const std::vector<float>& more, std::vector<float>& depth_m) {
  for (std::size_t i = 0; i < std::min(more.size(), depth_m.size()); ++i) {
    if (more[i] > 0.0f) depth_m[i] = depth_m[i] > 0.0f ? std::min(depth_m[i], more[i]) : more[i];
  }
}

}  // namespace

std::optional<ObjectEstimate> tellOthers(const TrackerResult& result, std::shared_ptr<const TriangleMesh> mesh) {
  if (!result.has_pose || result.state != TrackerState::kTracking || !isValidPose(result.T_camera_object)) {
    return std::nullopt;
  }
  ObjectEstimate estimate;
  estimate.mesh = std::move(mesh);
  estimate.stamp_s = result.stamp_s;
  estimate.T_camera_object = result.T_camera_object;
  if (result.twist.allFinite()) estimate.twist = result.twist;
  const double variance = result.covariance.diagonal().head<3>().maxCoeff();
  estimate.is_seen = result.score > kSeenScore && result.visible_fraction > kSeenVisibleFraction &&
                     variance < kSeenStddevM * kSeenStddevM;
  return estimate;
}

std::size_t OtherObjects::place(const std::vector<ObjectEstimate>& estimates, double stamp_s, KnownOccluders* besides) {
  for (auto& object : objects_) object->is_placed = false;
  for (const ObjectEstimate& estimate : estimates) {
    const double dt_s = stamp_s - estimate.stamp_s;
    if (!(std::abs(dt_s) <= kFarthestS)) continue;
    Object& object = objectFor(estimate.mesh);
    object.T_camera_object = perturb(estimate.T_camera_object, dt_s * estimate.twist);
    object.is_seen = estimate.is_seen;
    object.is_placed = true;
  }
  objects_.erase(std::remove_if(objects_.begin(), objects_.end(), [](const auto& one) { return !one->is_placed; }),
                 objects_.end());
  besides_ = besides;
  drawn_for_.reset();
  return objects_.size() + (besides != nullptr ? 1 : 0);
}

/// Renderers are kept from image to image; two objects may share a mesh.
OtherObjects::Object& OtherObjects::objectFor(const std::shared_ptr<const TriangleMesh>& mesh) {
  const auto known = std::find_if(objects_.begin(), objects_.end(),
                                  [&](const auto& one) { return !one->is_placed && one->mesh == mesh; });
  if (known != objects_.end()) return **known;
  objects_.push_back(std::make_unique<Object>(Object{mesh, DepthRenderer(*mesh)}));
  return *objects_.back();
}

/// All of them, and those that are seen: the same camera is mostly asked for both.
void OtherObjects::draw(const PinholeCamera& camera) {
  if (drawn_for_ && *drawn_for_ == camera) return;
  drawn_for_ = camera;
  const std::size_t num_pixels = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  depth_m_.assign(num_pixels, 0.0f);
  seen_depth_m_.assign(num_pixels, 0.0f);
  const auto merge = [](float more, float& depth) { depth = depth > 0.0f ? std::min(depth, more) : more; };
  for (auto& object : objects_) {
    for (const CoveredPixel& pixel : object->renderer.render(object->T_camera_object, camera)) {
      const std::size_t index = static_cast<std::size_t>(pixel.row) * static_cast<std::size_t>(camera.width) +
                                static_cast<std::size_t>(pixel.col);
      merge(pixel.depth, depth_m_[index]);
      if (object->is_seen) merge(pixel.depth, seen_depth_m_[index]);
    }
  }
  if (besides_ == nullptr) return;
  mergeNearest(besides_->render(camera), depth_m_);
  mergeNearest(besides_->renderSeen(camera), seen_depth_m_);
}

const std::vector<float>& OtherObjects::render(const PinholeCamera& camera) {
  draw(camera);
  return depth_m_;
}

const std::vector<float>& OtherObjects::renderSeen(const PinholeCamera& camera) {
  draw(camera);
  return seen_depth_m_;
}

}  // namespace depth_object_tracker
