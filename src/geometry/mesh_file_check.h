// SPDX-License-Identifier: BSD-3-Clause
// What is looked at before the bytes of a mesh file are handed to a parser.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

namespace depth_object_tracker {

constexpr std::uintmax_t kMaxMeshFileBytes = std::uintmax_t{512} << 20;
constexpr std::array<const char*, 4> kMeshExtensions = {"obj", "stl", "ply", "dae"};

/// Ending of a file name without its point, in small letters: `a.STL` -> `stl`.
/// @throws MeshError (without the file's name) when it is not one of kMeshExtensions.
std::string meshExtension(const std::filesystem::path& path);

/// Refuses what parsers are known to crash on or never to return from.
/// @throws MeshError what is wrong with the content, without the file's name.
void checkMeshContent(const std::string& content, const std::string& extension);

}  // namespace depth_object_tracker
