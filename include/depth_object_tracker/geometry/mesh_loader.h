// SPDX-License-Identifier: BSD-3-Clause
// Loads OBJ, STL, PLY and DAE meshes through assimp.
#pragma once

#include "depth_object_tracker/geometry/triangle_mesh.h"

#include <functional>
#include <stdexcept>
#include <string>

namespace depth_object_tracker {

/// What was read, from where, what is wrong and what to try; one sentence each, fit for a user.
class MeshError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Turns a package name into its folder ("" when unknown). The core knows no ROS: who has it hands it in.
using PackageResolver = std::function<std::string(const std::string& package)>;

constexpr double kMinMeshDiameterM = 0.005;
constexpr double kMaxMeshDiameterM = 5.0;

/// Path of `package://NAME/PATH`, `file://PATH` or a plain path.
/// @throws MeshError naming the package that could not be found, or a scheme that is not supported.
std::string resolveMeshUri(const std::string& uri, const PackageResolver& resolve_package = {});

/// Folder of the package that a `package://` URI names; "" for other URIs and unknown packages.
std::string packageFolder(const std::string& uri, const PackageResolver& resolve_package);

/// Loads a mesh: polygons triangulated, scene-graph transforms applied, corners at the same place joined, degenerate
/// triangles dropped, any winding. The axes are the file's own: a DAE file's unit is applied, its up axis is not (as
/// rviz does), so that the same part saved as .dae and as .stl has the same origin and axes.
/// @param uri `package://`, `file://` or plain path of an .obj, .stl, .ply or .dae file.
/// @param scale metres per unit of the file (.dae: on top of the unit that it declares), finite and > 0.
/// @throws MeshError when the file is missing, unreadable, empty, or its diameter is not in
///   [kMinMeshDiameterM, kMaxMeshDiameterM] (probably the wrong unit: the message proposes a scale).
TriangleMesh loadMesh(const std::string& uri, double scale = 1.0, const PackageResolver& resolve_package = {});

/// A way to load meshes: loadMesh() itself, or an IsolatedMeshLoader.
using MeshLoader = std::function<TriangleMesh(const std::string& uri, double scale)>;

}  // namespace depth_object_tracker
