// SPDX-License-Identifier: BSD-3-Clause
// Mesh files of all formats, as the program mesh_reader reads them, and its answer as the nodelet reads it. The first
// byte chooses the format.
#include "depth_object_tracker/geometry/mesh_loader.h"
#include "fuzz_input.h"
#include "geometry/mesh_file_check.h"
#include "geometry/mesh_parser.h"
#include "geometry/mesh_reply.h"

#include <cstdlib>
#include <new>

namespace dot = depth_object_tracker;

// assimp takes a buffer of 16 MiB for every OBJ and PLY file. Mapping it anew would take nine tenths of the time, so
// one such buffer stays; everything else is the sanitizer's.
namespace {
constexpr std::size_t kFileBufferBytes = 4096 * 4096;
void* file_buffer = nullptr;
bool is_file_buffer_taken = false;

void* take(std::size_t size) {
  if (size != kFileBufferBytes || is_file_buffer_taken) return std::malloc(size);
  if (file_buffer == nullptr) file_buffer = std::malloc(size);
  is_file_buffer_taken = file_buffer != nullptr;
  return file_buffer;
}

void giveBack(void* memory) {
  if (memory != nullptr && memory == file_buffer) {
    is_file_buffer_taken = false;
  } else {
    std::free(memory);
  }
}
}  // namespace

void* operator new(std::size_t size) {
  if (void* memory = take(size)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return take(size);
}
void operator delete(void* memory) noexcept {
  giveBack(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  giveBack(memory);
}
void operator delete(void* memory, const std::nothrow_t&) noexcept {
  giveBack(memory);
}

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
