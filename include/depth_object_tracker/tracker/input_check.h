// SPDX-License-Identifier: BSD-3-Clause
// Looks at camera, depth image, mesh and initial pose together for the mistakes that are easily made in setting up:
// units, intrinsics of another picture, axes. Each suspicion comes as a sentence that says what to do.
#pragma once

#include "depth_object_tracker/geometry/depth_image.h"
#include "depth_object_tracker/geometry/pinhole_camera.h"
#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/geometry/triangle_mesh.h"

#include <string>
#include <vector>

namespace depth_object_tracker {

struct InputFinding {
  enum class Kind {
    kNoDepth,
    kDepthUnit,
    kPixelAspect,     ///< fx and fy differ
    kPrincipalPoint,  ///< far from the middle of the image
    kFieldOfView,
    kMeshTooLarge,
    kMeshTooSmall,
    kPoseBehindCamera,
    kPoseOutsideImage,
    kPoseDepth  ///< the readings are far behind the object's initial pose
  };
  Kind kind;
  std::string message;  ///< what is odd, with its numbers, and what to do
};

using InputFindings = std::vector<InputFinding>;

/// What an even sample of a depth image's pixels says.
struct DepthSummary {
  double valid_fraction = 0.0;   ///< share of pixels with a reading, whatever its size
  double beyond_fraction = 0.0;  ///< share of the readings beyond max_depth_m
  double near_m = 0.0;           ///< 5 % of the readings are nearer; 0 when there is none
  double median_m = 0.0;
  double far_m = 0.0;  ///< 95 % of the readings are nearer
};

/// Reads a few thousand pixels. The view must fit its buffer.
DepthSummary summariseDepth(const DepthImageView& depth, double max_depth_m);

/// @param is_part the image is a region of the camera's picture: its middle may then be anywhere.
InputFindings checkCamera(const PinholeCamera& camera, bool is_part);

/// Units and presence of readings. @param pixel_type tells which unit is meant.
InputFindings checkDepth(const DepthSummary& depth, DepthImageView::PixelType pixel_type, double max_depth_m);

/// The mesh's size against what the camera sees. Nothing when there are no readings.
InputFindings checkMeshSize(double diameter_m, const DepthSummary& depth, const PinholeCamera& camera);

/// The initial pose against axes, image and readings. Renders the mesh once.
InputFindings checkInitialPose(const TriangleMesh& mesh, double diameter_m, const Pose& T_camera_object,
                               const DepthImageView& depth, const PinholeCamera& camera);

}  // namespace depth_object_tracker
