// SPDX-License-Identifier: BSD-3-Clause
// The shapes of a robot's links as triangle meshes.
#pragma once

#include "depth_object_tracker/geometry/mesh_loader.h"
#include "depth_object_tracker/robot/robot_model.h"

#include <string>
#include <vector>

namespace depth_object_tracker {

enum class LinkShapes { kVisual, kCollision };

struct LinkMesh {
  std::string link;
  TriangleMesh mesh;  ///< [m], link frame; all shapes of the link together
};

struct LinkMeshes {
  std::vector<LinkMesh> links;        ///< those that have a shape
  std::vector<std::string> problems;  ///< shapes that could not be read, one sentence each
};

/// Boxes, cylinders, spheres, and meshes through assimp. A link without shapes of the wanted kind takes those of the
/// other.
LinkMeshes loadLinkMeshes(const RobotModel& model, LinkShapes shapes, const PackageResolver& resolve_package = {});
LinkMeshes loadLinkMeshes(const RobotModel& model, LinkShapes shapes, const MeshLoader& load_mesh);

}  // namespace depth_object_tracker
