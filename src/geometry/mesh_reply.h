// SPDX-License-Identifier: BSD-3-Clause
// What the program mesh_reader answers: a mesh or a sentence, as bytes. The answer is not trusted: the file that it was
// made from may have taken the program over.
#pragma once

#include "depth_object_tracker/geometry/triangle_mesh.h"

#include <cstddef>
#include <string>
#include <string_view>

namespace depth_object_tracker {

constexpr std::size_t kMaxReplyBytes = std::size_t{512} << 20;
constexpr std::size_t kMaxReplyText = 1000;

/// @throws MeshError when the mesh is too large to be sent.
std::string encodeMeshReply(const TriangleMesh& mesh);
std::string encodeErrorReply(const std::string& message);

/// @throws MeshError with the sentence of the reply, or what is wrong with the reply: not complete, of another version,
/// a
///   vertex that is not finite, a triangle of vertices that do not exist.
TriangleMesh decodeReply(std::string_view reply);

}  // namespace depth_object_tracker
