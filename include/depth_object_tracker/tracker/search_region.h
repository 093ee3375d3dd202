// SPDX-License-Identifier: BSD-3-Clause
// Where a hidden or lost object may be.
#pragma once

#include "depth_object_tracker/geometry/depth_image.h"
#include "depth_object_tracker/geometry/pinhole_camera.h"
#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/render/known_occluders.h"

namespace depth_object_tracker {

/// Where the object may be.
struct SearchRegion {
  Pose T_camera_centre = Pose::Identity();
  Vector6d variances = Vector6d::Ones();  ///< [m^2, rad^2]
  Vector6d moved_on = Vector6d::Zero();   ///< [m, rad] it may have gone, had it moved on as when it was last seen
  double seen_distance_m = 0.0;           ///< where it was last surely seen: pixels must be fine enough for that, too
  bool is_known = true;                   ///< false: anywhere in the image
  bool everywhere = false;                ///< is_known: in the rest of the image, too, else in every third one
  bool on_table = false;                  ///< not is_known: it rests on a plane that the image shows
  double unseen_s = 0.0;                  ///< since it was seen last
  bool was_followed = false;              ///< surely, until it was seen no more
  double memory_s = 0.0;                  ///< since remember()
  KnownOccluders* occluders = nullptr;    ///< the object is not where one of them is seen; null = none
};

/// Of a pose from where the object is expected, in squared standard deviations; 6 on average for the right one.
double squaredDistance(const Pose& pose, const SearchRegion& region);

/// 0 where the object is expected, 1 far from it.
double remoteness(const Pose& pose, const SearchRegion& region);

/// Evidence [nat] in [0, 4] against a pose that an object which was followed until something hid it could hardly have
/// reached.
double outOfReach(const Pose& pose, const SearchRegion& region);

/// Of the places where the object may be, those at which something in front would hide it. In [0, 1].
double hiddenShare(const SearchRegion& region, const DepthImageView& depth, const PinholeCamera& camera);

}  // namespace depth_object_tracker
