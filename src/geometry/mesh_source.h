// SPDX-License-Identifier: BSD-3-Clause
// What loading a mesh here and in a process of its own have in common.
#pragma once

#include "depth_object_tracker/geometry/file_access.h"
#include "depth_object_tracker/geometry/mesh_loader.h"

#include <functional>
#include <string>

namespace depth_object_tracker {

/// Triangles of an open file. @throws MeshError what is wrong, without the file's name.
using FileParser = std::function<TriangleMesh(const InputFile& file, const std::string& extension, double scale)>;

/// loadMesh() with the parser and the places that the file may lie in, its own package among them.
TriangleMesh loadMeshFrom(const std::string& uri, double scale, const FileAccess& access,
                          const PackageResolver& resolve_package, const FileParser& parse);

}  // namespace depth_object_tracker
