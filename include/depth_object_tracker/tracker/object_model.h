// SPDX-License-Identifier: BSD-3-Clause
// What the tracker knows of an object: name, mesh, symmetries; and its YAML file.
#pragma once

#include "depth_object_tracker/geometry/file_access.h"
#include "depth_object_tracker/geometry/mesh_loader.h"
#include "depth_object_tracker/geometry/symmetry.h"
#include "depth_object_tracker/geometry/triangle_mesh.h"

#include <string>

namespace depth_object_tracker {

struct ObjectModel {
  std::string name = "object";
  TriangleMesh mesh;
  Symmetries symmetries;
};

/// Where an object's mesh comes from, as written in its YAML file.
struct ObjectDescription {
  std::string name;
  std::string mesh;         ///< `package://`, `file://`, absolute, or relative to the YAML file's folder
  double mesh_scale = 1.0;  ///< metres per unit of the mesh file
  Symmetries symmetries;    ///< offsets and translations in metres (after mesh_scale)
};

/// Reads `name, mesh, mesh_scale, symmetries: {continuous: [{axis, offset}], discrete: [[16 numbers, row-major]]}`;
/// offsets and translations in the file are in the mesh file's unit.
/// @param access places that the file may lie in.
/// @throws std::invalid_argument naming file, key and what is wrong; unknown keys are errors.
ObjectDescription loadObjectDescription(const std::string& yaml_file, const FileAccess& access = {});

/// The same from the file's text. @param yaml_file its name, for messages and relative mesh paths.
ObjectDescription parseObjectDescription(const std::string& text, const std::string& yaml_file);

/// Loads the mesh of a description. @throws MeshError
ObjectModel loadObject(const ObjectDescription& description, const PackageResolver& resolve_package = {});
ObjectModel loadObject(const ObjectDescription& description, const MeshLoader& load_mesh);

}  // namespace depth_object_tracker
