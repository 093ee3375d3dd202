// SPDX-License-Identifier: BSD-3-Clause
// What is rendered of an object: its mesh at several levels of detail, and the point that poses are about.
#pragma once

#include "depth_object_tracker/geometry/triangle_mesh.h"
#include "depth_object_tracker/model/measured_image.h"
#include "depth_object_tracker/render/render_levels.h"

#include <Eigen/Core>

#include <memory>

namespace depth_object_tracker {

/// The rendered shape of an object, and the point of it that poses are about.
struct ObjectShape {
  /// @param level_of_detail false: only the mesh itself.
  ObjectShape(const TriangleMesh& mesh, const Eigen::Vector3d& centre_object, bool level_of_detail = true);

  std::shared_ptr<const RenderLevels> levels;
  Eigen::Vector3d centre_object;  ///< [m]
  double radius_m;                ///< of the bounding sphere about the centre
};

/// How far (rms) a simplified mesh may be from the surface [m]: little against the noise of a pixel, and against its
/// size on the object. Noise averages out over the pixels, the error of a mesh much less.
/// @param cell_m [m] side of a grid cell at the object.
double allowedLevelError(double depth_m, double cell_m, const PixelModelConfig& config);

}  // namespace depth_object_tracker
