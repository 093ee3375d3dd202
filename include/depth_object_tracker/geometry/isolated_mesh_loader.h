// SPDX-License-Identifier: BSD-3-Clause
// Loads meshes in a short-lived process: a hostile or damaged file takes that process down, not this one.
#pragma once

#include "depth_object_tracker/geometry/file_access.h"
#include "depth_object_tracker/geometry/mesh_loader.h"

#include <cstdint>
#include <string>
#include <vector>

namespace depth_object_tracker {

struct MeshProcessLimits {
  std::uint64_t memory_mib = 3072;  ///< address space of the process
  unsigned cpu_s = 30;              ///< processor time
  double wall_s = 60.0;             ///< waiting included
  std::size_t reply_mib = 512;      ///< of vertices and triangles
};

/// Where the program mesh_reader may be, seen from this library: in its devel space, build folder or install tree.
std::vector<std::string> listMeshReaderPlaces();

class IsolatedMeshLoader {
 public:
  /// @param program path of mesh_reader; empty = the first of listMeshReaderPlaces() that is there.
  explicit IsolatedMeshLoader(PackageResolver resolve_package = {}, FileAccess access = {},
                              MeshProcessLimits limits = {}, std::string program = "");

  /// As loadMesh(); a MeshError also when the process ends badly, exceeds its limits or cannot be started. Safe on any
  /// thread.
  TriangleMesh operator()(const std::string& uri, double scale = 1.0) const;

 private:
  PackageResolver resolve_package_;
  FileAccess access_;
  MeshProcessLimits limits_;
  std::string program_;
};

}  // namespace depth_object_tracker
