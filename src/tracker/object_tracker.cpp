// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/tracker/object_tracker.h"

namespace depth_object_tracker {

class ObjectTracker::Implementation {
 public:
  ObjectModel object;
  TrackerConfig config;
  TrackerResult result;
};

ObjectTracker::ObjectTracker(ObjectModel object, const TrackerConfig& config)
    : implementation_(std::make_unique<Implementation>()) {
  implementation_->object = std::move(object);
  implementation_->config = config;
}
ObjectTracker::~ObjectTracker() = default;
ObjectTracker::ObjectTracker(ObjectTracker&&) noexcept = default;
ObjectTracker& ObjectTracker::operator=(ObjectTracker&&) noexcept = default;

void ObjectTracker::initialise(const Pose& T_camera_object, const Matrix6d& covariance) {
  implementation_->result.T_camera_object = T_camera_object;
  implementation_->result.covariance = covariance;
  implementation_->result.has_pose = true;
  implementation_->result.state = TrackerState::kTracking;
}
void ObjectTracker::reset() { implementation_->result = TrackerResult(); }
TrackerResult ObjectTracker::update(const DepthImageView&, const PinholeCamera&, double stamp_s,
                                    const std::optional<ControlInput>&) {
  implementation_->result.stamp_s = stamp_s;
  return implementation_->result;
}
ParticlePoses ObjectTracker::particles() const { return {}; }
OcclusionMap ObjectTracker::occlusionMap() const { return {}; }
std::vector<float> ObjectTracker::renderEstimate() const { return {}; }
const ObjectModel& ObjectTracker::object() const { return implementation_->object; }
const TrackerConfig& ObjectTracker::config() const { return implementation_->config; }
double ObjectTracker::diameterM() const { return diameter(implementation_->object.mesh); }

}  // namespace depth_object_tracker
