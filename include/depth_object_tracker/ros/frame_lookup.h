// SPDX-License-Identifier: BSD-3-Clause
// Where one frame is in another at the time of an image; tf may come a little after the image.
#pragma once

#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/tracker/tracker_result.h"

#include <tf2/buffer_core.h>

#include <chrono>
#include <string>

namespace depth_object_tracker {

/// Frames besides the camera's, and how long an image waits for their transforms.
struct FrameOptions {
  std::string target_frame;  ///< frame of poses, twists, particles and tf; empty = the camera's optical frame
  std::string fixed_frame;   ///< the camera moves in it, and the object is expected to rest in it; empty = as if the
                             ///< camera stood still
  double transform_wait_s = 0.05;  ///< longest wait for the transforms of an image
};

struct FrameLookup {
  Pose T_target_source = Pose::Identity();
  std::string problem;  ///< empty = found; otherwise both frames, the stamp and what tf says
};

/// Waits until `deadline` for a transform that is likely to come: when the frames are connected and the last transform
/// is hardly older than the image.
FrameLookup lookUpFrame(const tf2::BufferCore& tf, const std::string& target, const std::string& source,
                        const ros::Time& stamp, std::chrono::steady_clock::time_point deadline);

/// The same estimate told in another frame: pose, twist and both covariances. "T_camera_object" of what is returned is
/// T_target_object.
TrackerResult toFrame(TrackerResult result, const Pose& T_target_camera);

}  // namespace depth_object_tracker
