// SPDX-License-Identifier: BSD-3-Clause
// The answer of a mesh_reader that its file has taken over. An accepted one must be a mesh that can be used.
#include "depth_object_tracker/geometry/mesh_loader.h"
#include "fuzz_input.h"
#include "geometry/mesh_reply.h"

#include <string_view>

namespace dot = depth_object_tracker;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const dot::TriangleMesh mesh = dot::decodeReply({reinterpret_cast<const char*>(data), size});
    for (const auto& triangle : mesh.triangles) {
      for (const std::uint32_t index : triangle) {
        if (!mesh.vertices.at(index).allFinite()) __builtin_trap();
      }
    }
    if (dot::encodeMeshReply(mesh) != dot::toText(data, size)) __builtin_trap();
  } catch (const dot::MeshError& error) {
    const std::string message = error.what();
    if (dot::encodeErrorReply(message).empty()) __builtin_trap();
    for (const char letter : message) {
      if (letter == '\n' || letter == '\x1b') __builtin_trap();
    }
  }
  return 0;
}
