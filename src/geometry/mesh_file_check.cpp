// SPDX-License-Identifier: BSD-3-Clause
// Damaged, misnamed and hostile files are told apart here, with a sentence for the user.
#include "mesh_file_check.h"

#include "depth_object_tracker/geometry/mesh_loader.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <set>
#include <sstream>
#include <system_error>

namespace depth_object_tracker {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{512} << 20;
constexpr std::array<const char*, 4> kExtensions = {"obj", "stl", "ply", "dae"};

std::string formatCount(double count) {
  std::ostringstream stream;
  stream.precision(15);
  stream << count;
  return stream.str();
}

/// What is wrong with one line of a PLY header, "" when nothing is. Adds an element's count to `num_elements`.
std::string findPlyProblem(const std::string& line, double& num_elements) {
  static const std::set<std::string> kKeywords = {"ply", "format", "comment", "obj_info", "element", "property"};
  std::istringstream words(line);
  std::string keyword, name;
  if (!(words >> keyword) || kKeywords.count(keyword) == 0) return "its header has the line '" + line + "'";
  double count = 0.0;
  if (keyword == "element" && !(words >> name >> count && count >= 0.0)) return "its header has the line '" + line + "'";
  num_elements += count;
  return "";
}

/// assimp's PLY reader does not return from headers that do not end, and trusts their counts with its memory.
void checkPlyHeader(const fs::path& path, std::uintmax_t num_bytes) {
  constexpr int kMaxHeaderLines = 1000;
  const std::string name = "mesh " + path.string() + ": cannot be read as .ply: ";
  std::ifstream file(path, std::ios::binary);
  std::string line;
  double num_elements = 0.0;
  for (int i = 0; i < kMaxHeaderLines && std::getline(file, line); ++i) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (i == 0 && line != "ply") throw MeshError(name + "it does not begin with the line 'ply'.");
    if (line == "end_header") {
      // An element takes at least one byte.
      const double num_data_bytes = file.eof() ? 0.0 : static_cast<double>(num_bytes) - static_cast<double>(file.tellg());
      if (num_elements > 0.0 && num_elements <= num_data_bytes) return;
      throw MeshError(name + "its header promises " + formatCount(num_elements) + " elements, " + formatCount(num_data_bytes) +
                      " bytes follow.");
    }
    const std::string problem = findPlyProblem(line, num_elements);
    if (!problem.empty()) throw MeshError(name + problem + ".");
  }
  throw MeshError(name + "its header has no line 'end_header'.");
}

}  // namespace

std::string lowerCaseExtension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  for (char& letter : extension) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return extension;
}

/// Opening a pipe would block and a directory reads as garbage: look before.
void checkMeshFile(const std::filesystem::path& path) {
  const std::string name = "mesh " + path.string() + ": ";
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) throw MeshError(name + "the file does not exist.");
  if (status.type() == fs::file_type::none) throw MeshError(name + "cannot be looked up: " + error.message() + ".");
  if (status.type() == fs::file_type::directory) {
    throw MeshError(name + "is a folder; give the path of the .obj, .stl, .ply or .dae file in it.");
  }
  if (status.type() != fs::file_type::regular) throw MeshError(name + "is not a regular file.");
  const std::string extension = lowerCaseExtension(path);
  if (std::find(kExtensions.begin(), kExtensions.end(), extension) == kExtensions.end()) {
    throw MeshError(name + "the format '." + extension + "' is not supported; convert it to .obj, .stl, .ply or .dae.");
  }
  const std::uintmax_t num_bytes = fs::file_size(path, error);
  if (error) throw MeshError(name + "its size cannot be read: " + error.message() + ".");
  if (num_bytes == 0) throw MeshError(name + "the file is empty.");
  if (num_bytes > kMaxFileBytes) {
    throw MeshError(name + "the file has " + std::to_string(num_bytes >> 20) + " MiB, more than the " +
                    std::to_string(kMaxFileBytes >> 20) + " MiB that are accepted; simplify the mesh first.");
  }
  if (!std::ifstream(path)) throw MeshError(name + "the file cannot be opened: check its permissions.");
  if (extension == "ply") checkPlyHeader(path, num_bytes);
}

}  // namespace depth_object_tracker
