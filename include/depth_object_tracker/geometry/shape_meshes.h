// SPDX-License-Identifier: BSD-3-Clause
// Simple closed meshes from which hands, grippers, arms, boards and the room are put together.
#pragma once

#include "depth_object_tracker/geometry/pose.h"
#include "depth_object_tracker/geometry/triangle_mesh.h"

namespace depth_object_tracker {

/// Box about the origin. @param size edge lengths [m]
TriangleMesh makeBox(const Eigen::Vector3d& size);

/// Ellipsoid about the origin. @param radii half axes [m]
TriangleMesh makeEllipsoid(const Eigen::Vector3d& radii, int segments = 16);

/// Cylinder with round ends between two points, radius going from `radius_from_m` to `radius_to_m`.
TriangleMesh makeCapsule(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius_from_m,
                         double radius_to_m, int segments = 12);

/// Cylinder with flat ends about the origin, along z.
TriangleMesh makeCylinder(double radius_m, double length_m, int segments = 24);

/// Adds `part`, placed at T_mesh_part, to `mesh`.
void appendMesh(TriangleMesh& mesh, const TriangleMesh& part, const Pose& T_mesh_part = Pose::Identity());

/// Some rotation whose z axis points along `direction` (any length > 0).
Eigen::Matrix3d rotationWithZ(const Eigen::Vector3d& direction);

}  // namespace depth_object_tracker
