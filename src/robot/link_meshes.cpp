// SPDX-License-Identifier: BSD-3-Clause
#include "depth_object_tracker/robot/link_meshes.h"

#include "depth_object_tracker/geometry/shape_meshes.h"

#include <urdf_model/model.h>

#include <cmath>
#include <filesystem>

namespace depth_object_tracker {
namespace {

Pose toPose(const urdf::Pose& urdf_pose) {
  const urdf::Rotation& q = urdf_pose.rotation;
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
  pose.translation() = Eigen::Vector3d(urdf_pose.position.x, urdf_pose.position.y, urdf_pose.position.z);
  return pose;
}

/// Scaled along each axis; negative factors mirror.
TriangleMesh loadScaled(const urdf::Mesh& shape, const RobotModel& model, const MeshLoader& load_mesh) {
  std::string uri = shape.filename;
  const bool is_relative = uri.find("://") == std::string::npos && !std::filesystem::path(uri).is_absolute();
  if (is_relative) uri = (std::filesystem::path(model.source()).parent_path() / uri).string();
  const double scale = std::abs(shape.scale.x);
  if (!(scale > 0.0)) throw MeshError("mesh '" + uri + "' has scale 0");
  TriangleMesh mesh = load_mesh(uri, scale);
  const Eigen::Vector3f ratio = (Eigen::Vector3d(shape.scale.x, shape.scale.y, shape.scale.z) / scale).cast<float>();
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex = vertex.cwiseProduct(ratio);
  return mesh;
}

TriangleMesh toMesh(const urdf::Geometry& geometry, const RobotModel& model, const MeshLoader& load_mesh) {
  switch (geometry.type) {
    case urdf::Geometry::BOX: {
      const urdf::Vector3& size = static_cast<const urdf::Box&>(geometry).dim;
      return makeBox({size.x, size.y, size.z});
    }
    case urdf::Geometry::SPHERE:
      return makeEllipsoid(Eigen::Vector3d::Constant(static_cast<const urdf::Sphere&>(geometry).radius));
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
      return makeCylinder(cylinder.radius, cylinder.length);
    }
    case urdf::Geometry::MESH:
      return loadScaled(static_cast<const urdf::Mesh&>(geometry), model, load_mesh);
  }
  return {};
}

/// @param shapes urdf::Visual or urdf::Collision pointers.
template <typename Shapes>
TriangleMesh merge(const Shapes& shapes, const RobotModel& model, const MeshLoader& load_mesh, const std::string& link,
                   std::vector<std::string>& problems) {
  TriangleMesh mesh;
  for (const auto& shape : shapes) {
    if (!shape || !shape->geometry) continue;
    try {
      appendMesh(mesh, toMesh(*shape->geometry, model, load_mesh), toPose(shape->origin));
    } catch (const std::exception& error) {
      problems.push_back("a shape of link '" + link + "' is left out: " + error.what());
    }
  }
  return mesh;
}

}  // namespace

LinkMeshes loadLinkMeshes(const RobotModel& model, LinkShapes shapes, const MeshLoader& load_mesh) {
  LinkMeshes result;
  for (const auto& [name, link] : model.description().links_) {
    const bool visual = shapes == LinkShapes::kVisual ? !link->visual_array.empty() : link->collision_array.empty();
    TriangleMesh mesh = visual ? merge(link->visual_array, model, load_mesh, name, result.problems)
                               : merge(link->collision_array, model, load_mesh, name, result.problems);
    if (!mesh.triangles.empty()) result.links.push_back({name, std::move(mesh)});
  }
  return result;
}

LinkMeshes loadLinkMeshes(const RobotModel& model, LinkShapes shapes, const PackageResolver& resolve_package) {
  return loadLinkMeshes(model, shapes, [&resolve_package](const std::string& uri, double scale) {
    return loadMesh(uri, scale, resolve_package);
  });
}

}  // namespace depth_object_tracker
