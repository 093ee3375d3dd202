// SPDX-License-Identifier: BSD-3-Clause
// The other tracked objects in the view, as known occluders: each one's tracker says where it is.
#pragma once

#include "depth_object_tracker/geometry/triangle_mesh.h"
#include "depth_object_tracker/render/depth_renderer.h"
#include "depth_object_tracker/render/known_occluders.h"
#include "depth_object_tracker/tracker/tracker_result.h"

#include <memory>
#include <optional>
#include <vector>

namespace depth_object_tracker {

/// What one tracker tells the others.
struct ObjectEstimate {
  std::shared_ptr<const TriangleMesh> mesh;  ///< [m]; never null
  double stamp_s = 0.0;                      ///< of the image
  Pose T_camera_object = Pose::Identity();   ///< of the mesh origin
  Vector6d twist = Vector6d::Zero();         ///< of the mesh origin [m/s, rad/s], optical-frame axes
  bool is_seen = false;                      ///< where it is thought to be, within millimetres
};

/// @return nothing to be told of an object that is hidden, lost or not found yet: an occluder must be where it is said
/// to be.
std::optional<ObjectEstimate> tellOthers(const TrackerResult& result, std::shared_ptr<const TriangleMesh> mesh);

/// Not thread-safe.
class OtherObjects : public KnownOccluders {
 public:
  /// Places them for the image of this stamp, moved at their velocities. Estimates of images more than 0.2 s before or
  /// after are left out. @param besides more occluders, already placed; may be null, must outlive
  /// rendering.
  /// @return number of occluders, with `besides` as one.
  std::size_t place(const std::vector<ObjectEstimate>& estimates, double stamp_s, KnownOccluders* besides = nullptr);

  const std::vector<float>& render(const PinholeCamera& camera) override;
  const std::vector<float>& renderSeen(const PinholeCamera& camera) override;

 private:
  struct Object {
    std::shared_ptr<const TriangleMesh> mesh;
    DepthRenderer renderer;
    Pose T_camera_object = Pose::Identity();
    bool is_placed = false, is_seen = false;
  };
  Object& objectFor(const std::shared_ptr<const TriangleMesh>& mesh);
  void draw(const PinholeCamera& camera);

  std::vector<std::unique_ptr<Object>> objects_;
  KnownOccluders* besides_ = nullptr;
  std::optional<PinholeCamera> drawn_for_;  // what the two images below are of
  std::vector<float> depth_m_, seen_depth_m_;
};

}  // namespace depth_object_tracker
