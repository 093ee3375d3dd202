// SPDX-License-Identifier: BSD-3-Clause
// Facade of the tracker: an initial pose and a stream of depth images in, an estimate per image out.
#pragma once

#include "depth_object_tracker/geometry/depth_image.h"
#include "depth_object_tracker/geometry/pinhole_camera.h"
#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/model/control_input.h"
#include "depth_object_tracker/render/known_occluders.h"
#include "depth_object_tracker/tracker/object_model.h"
#include "depth_object_tracker/tracker/plane_finder.h"
#include "depth_object_tracker/tracker/tracker_config.h"
#include "depth_object_tracker/tracker/tracker_result.h"

#include <memory>
#include <optional>

namespace depth_object_tracker {

/// Follows one rigid object. Not thread-safe: one thread calls at a time. Never throws after construction but
/// std::bad_alloc.
class ObjectTracker {
 public:
  /// @throws std::invalid_argument when the mesh has no triangle or a parameter is out of range.
  ObjectTracker(ObjectModel object, const TrackerConfig& config);
  ~ObjectTracker();
  ObjectTracker(ObjectTracker&&) noexcept;
  ObjectTracker& operator=(ObjectTracker&&) noexcept;

  /// Starts anew from a pose in the camera's optical frame, at the next update.
  /// @param covariance of the mesh origin's pose (REP-103 order); all zero = the configured default.
  void initialise(const Pose& T_camera_object, const Matrix6d& covariance = Matrix6d::Zero());

  /// Starts anew with nothing but the images: INITIALIZING, without a pose, until the object is surely seen. Takes some
  /// tenths of a second of computing an image; needs the informed proposal.
  void initialiseAnywhere();

  /// Likewise, with the object resting on a plane that the images show, turned and placed anyhow: fewer poses are
  /// tried.
  void initialiseOnTable();

  /// The plane on which initialiseOnTable() looks, in the last image; nullopt when none was found.
  std::optional<ImagePlane> table() const;

  /// Forgets the object: UNINITIALIZED until the next initialise().
  void reset();

  /// The camera has moved since the last update: what is remembered is told in its new axes, so that an object at rest
  /// in the world stays at rest, and twists are relative to the world. Occlusion beliefs stay with their pixels.
  /// @param T_now_before p_now = T_now_before * p_before, of points at rest in the world.
  void moveCamera(const Pose& T_now_before);

  /// Share of the configured computing effort to spend on the next images, in (0, 1]: particles and pixels are both
  /// reduced to its square root. See FrameBudget.
  void setEffort(double effort);

  /// Takes over the parameters that may change between two images (listLiveParameters()); the others stay.
  /// @throws std::invalid_argument, changing nothing, when one is out of range.
  void setLiveParameters(const TrackerConfig& changed);

  /// Moves the estimate to the image's stamp.
  /// @param stamp_s seconds of the image's exposure; equal to the last one: ignored (counted); before it: see design,
  /// time jump.
  /// @param control motion of a held object since the previous image; nullopt = the object is not held.
  /// @param occluders what is known to stand in the view besides the object; null = nothing. It need not be exact.
  /// The view is read only during the call.
  TrackerResult update(const DepthImageView& depth, const PinholeCamera& camera, double stamp_s,
                       const std::optional<ControlInput>& control = std::nullopt, KnownOccluders* occluders = nullptr);

  /// The weighted particles of the last update (mesh origin, weights sum to 1, before resampling). Empty before the
  /// first.
  ParticlePoses particles() const;

  /// Mean occlusion probability over the particles at working resolution. Empty before the first update.
  OcclusionMap occlusionMap() const;

  /// Depth of the object rendered at the last estimate at full resolution; 0 where it is not.
  /// For overlays and masks; not on the hot path.
  std::vector<float> renderEstimate() const;

  const ObjectModel& object() const;
  const TrackerConfig& config() const;
  double diameterM() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace depth_object_tracker
