// SPDX-License-Identifier: BSD-3-Clause
// Mesh files of all formats, as the program mesh_reader reads them, and its answer as the nodelet reads it. The first
// byte chooses the format.
#include "depth_object_tracker/geometry/mesh_loader.h"
#include "fuzz_input.h"
#include "geometry/mesh_file_check.h"
#include "geometry/mesh_parser.h"
#include "geometry/mesh_reply.h"
#include "mesh_fuzzer_memory.h"

namespace dot = depth_object_tracker;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string extension = dot::kMeshExtensions[data[0] % dot::kMeshExtensions.size()];
  static dot::MeshParser parser;
  dot::TriangleMesh mesh;
  try {
    if (dot::meshExtension("part." + extension) != extension) __builtin_trap();
    mesh = parser.parse(dot::toText(data + 1, size - 1), extension, 1.0);
  } catch (const dot::MeshError&) {
    return 0;
  }
  const std::string reply = dot::encodeMeshReply(mesh);
  if (dot::decodeReply(reply).triangles != mesh.triangles) __builtin_trap();
  return 0;
}
