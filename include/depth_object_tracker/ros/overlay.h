// SPDX-License-Identifier: BSD-3-Clause
// The picture that shows what the tracker believes: depth in shaded grey, the object tinted by its occlusion, its
// outline.
#pragma once

#include "depth_object_tracker/geometry/depth_image.h"
#include "depth_object_tracker/tracker/tracker_result.h"

#include <sensor_msgs/Image.h>

#include <vector>

namespace depth_object_tracker {

/// Draws at the size of the depth image, bgr8. Header left empty.
/// @param rendered depth of the object [m] at the image's size, 0 where it is not; empty = no object to show.
/// @param occlusion tints the object from green (visible) to red (occluded).
sensor_msgs::ImagePtr drawOverlay(const DepthImageView& depth, const PinholeCamera& camera,
                                  const std::vector<float>& rendered, const OcclusionMap& occlusion);

}  // namespace depth_object_tracker
