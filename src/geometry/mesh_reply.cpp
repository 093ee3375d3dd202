// SPDX-License-Identifier: BSD-3-Clause
// Layout, in the machine's byte order: four 32-bit words (magic, kind, two counts), then 3 floats a vertex and 3 words
// a triangle, or the text.
#include "mesh_reply.h"

#include "depth_object_tracker/geometry/mesh_loader.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>

namespace depth_object_tracker {
namespace {

constexpr std::uint32_t kMagic = 0x314d5444;  // "DTM1": other layouts take another number
enum Kind : std::uint32_t { kMesh = 1, kError = 2 };
using Header = std::array<std::uint32_t, 4>;

constexpr std::size_t kVertexBytes = 3 * sizeof(float), kTriangleBytes = 3 * sizeof(std::uint32_t);
static_assert(sizeof(Eigen::Vector3f) == kVertexBytes && sizeof(TriangleMesh{}.triangles[0]) == kTriangleBytes);

std::string encode(const Header& header, const void* first, std::size_t first_bytes, const void* second = nullptr,
                   std::size_t second_bytes = 0) {
  std::string reply(sizeof(header) + first_bytes + second_bytes, '\0');
  std::memcpy(&reply[0], header.data(), sizeof(header));
  if (first_bytes > 0) std::memcpy(&reply[sizeof(header)], first, first_bytes);
  if (second_bytes > 0) std::memcpy(&reply[sizeof(header) + first_bytes], second, second_bytes);
  return reply;
}

[[noreturn]] void refuse(const std::string& what) {
  throw MeshError("the answer of the program that read it cannot be used: " + what);
}

/// A sentence goes to logs and terminals: no control characters.
std::string printable(std::string_view text) {
  std::string clean(text.substr(0, kMaxReplyText));
  std::replace_if(
      clean.begin(), clean.end(), [](unsigned char letter) { return std::iscntrl(letter) != 0; }, ' ');
  return clean;
}

TriangleMesh decodeMesh(std::string_view body, std::uint64_t num_vertices, std::uint64_t num_triangles) {
  if (body.size() != num_vertices * kVertexBytes + num_triangles * kTriangleBytes) refuse("it is not complete");
  TriangleMesh mesh;
  mesh.vertices.resize(num_vertices);
  mesh.triangles.resize(num_triangles);
  const std::size_t vertex_bytes = num_vertices * kVertexBytes;
  if (num_vertices > 0) std::memcpy(static_cast<void*>(mesh.vertices.data()), body.data(), vertex_bytes);
  if (num_triangles > 0) std::memcpy(mesh.triangles.data(), body.data() + vertex_bytes, num_triangles * kTriangleBytes);
  const auto is_finite = [](const Eigen::Vector3f& vertex) { return vertex.allFinite(); };
  if (!std::all_of(mesh.vertices.begin(), mesh.vertices.end(), is_finite)) refuse("a vertex is not finite");
  for (const auto& triangle : mesh.triangles) {
    if (*std::max_element(triangle.begin(), triangle.end()) >= num_vertices) refuse("a vertex does not exist");
  }
  return mesh;
}

}  // namespace

std::string encodeMeshReply(const TriangleMesh& mesh) {
  const std::size_t vertex_bytes = mesh.vertices.size() * kVertexBytes;
  const std::size_t triangle_bytes = mesh.triangles.size() * kTriangleBytes;
  if (sizeof(Header) + vertex_bytes + triangle_bytes > kMaxReplyBytes) {
    throw MeshError("it has " + std::to_string(mesh.triangles.size()) +
                    " triangles, more than are accepted; simplify the mesh first");
  }
  const Header header = {kMagic, kMesh, static_cast<std::uint32_t>(mesh.vertices.size()),
                         static_cast<std::uint32_t>(mesh.triangles.size())};
  return encode(header, mesh.vertices.data(), vertex_bytes, mesh.triangles.data(), triangle_bytes);
}

std::string encodeErrorReply(const std::string& message) {
  const std::string text = message.substr(0, kMaxReplyText);
  return encode({kMagic, kError, static_cast<std::uint32_t>(text.size()), 0}, text.data(), text.size());
}

TriangleMesh decodeReply(std::string_view reply) {
  Header header;
  if (reply.size() < sizeof(header)) refuse("it is too short");
  std::memcpy(header.data(), reply.data(), sizeof(header));
  const auto [magic, kind, first_count, second_count] = header;
  const std::string_view body = reply.substr(sizeof(header));
  if (magic != kMagic) refuse("it is not of this version");
  if (kind == kMesh) return decodeMesh(body, first_count, second_count);
  if (kind != kError || body.size() != first_count) refuse("it is not complete");
  throw MeshError(printable(body));
}

}  // namespace depth_object_tracker
