// SPDX-License-Identifier: BSD-3-Clause
// What is looked at before a mesh file is handed to a parser.
#pragma once

#include <filesystem>
#include <string>

namespace depth_object_tracker {

/// Ending of a file name without its point, in small letters: `a.STL` -> `stl`.
std::string lowerCaseExtension(const std::filesystem::path& path);

/// @throws MeshError when the path is not a readable, reasonably large file of a supported format.
void checkMeshFile(const std::filesystem::path& path);

}  // namespace depth_object_tracker
