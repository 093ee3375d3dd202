// SPDX-License-Identifier: BSD-3-Clause
// The bytes of a mesh file to triangles.
#pragma once

#include "depth_object_tracker/geometry/triangle_mesh.h"

#include <memory>
#include <string>

namespace depth_object_tracker {

/// Makes the parsers once, for many files. Not thread-safe.
class MeshParser {
 public:
  MeshParser();
  ~MeshParser();

  /// The triangles as the file has them, degenerate ones too; what loadMesh() says of polygons, units and axes holds.
  /// @param extension one of kMeshExtensions. @param scale metres per unit of the file, finite and > 0.
  /// @throws MeshError what is wrong with the content, without the file's name.
  TriangleMesh parse(const std::string& content, const std::string& extension, double scale);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// The same for a single file.
TriangleMesh parseMesh(const std::string& content, const std::string& extension, double scale);

}  // namespace depth_object_tracker
