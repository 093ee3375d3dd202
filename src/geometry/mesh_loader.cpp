// SPDX-License-Identifier: BSD-3-Clause
// Mesh files to triangles in metres; assimp reads, and everything that a user may get wrong is answered here.
#include "depth_object_tracker/geometry/mesh_loader.h"

#include <assimp/BaseImporter.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <assimp/Importer.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <new>
#include <set>
#include <sstream>
#include <unordered_map>
#include <utility>

namespace depth_object_tracker {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{512} << 20;
constexpr std::size_t kMaxTriangles = 20'000'000;
constexpr std::array<const char*, 4> kExtensions = {"obj", "stl", "ply", "dae"};

std::string formatNumber(double value) {
  std::ostringstream stream;
  stream.precision(4);
  stream << value;
  return stream.str();
}

/// `.STL` -> `stl`.
std::string lowerCaseExtension(const fs::path& path) {
  std::string extension = path.extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  for (char& letter : extension) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return extension;
}

/// assimp may open the mesh file and nothing else: materials and textures are of no use here, and a hostile file could name a
/// device or a pipe.
class SingleFileSystem : public Assimp::DefaultIOSystem {
 public:
  explicit SingleFileSystem(std::string path) : path_(std::move(path)) {}
  bool Exists(const char* file) const override { return path_ == file; }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    return path_ == file ? DefaultIOSystem::Open(file, mode) : nullptr;
  }

 private:
  std::string path_;
};

/// Without this, assimp would try its forty other formats on any file whose ending does not tell.
void keepSupportedImporters(Assimp::Importer& importer) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    Assimp::BaseImporter* format = importer.GetImporter(i);
    std::set<std::string> extensions;
    format->GetExtensionList(extensions);
    const bool is_supported = std::any_of(kExtensions.begin(), kExtensions.end(),
                                          [&](const char* extension) { return extensions.count(extension) > 0; });
    if (is_supported) continue;
    importer.UnregisterLoader(format);
    delete format;  // unregistering hands the ownership back
  }
}

/// Gathers the triangles of a scene; corners at exactly the same place become one vertex, also across materials.
class TriangleCollector {
 public:
  /// Walks the scene graph. @return false when it holds too many triangles.
  bool collect(const aiScene& scene, double scale) {
    using Node = std::pair<const aiNode*, Eigen::Affine3d>;
    std::vector<Node> stack = {{scene.mRootNode, Eigen::Affine3d(Eigen::Scaling(scale))}};
    while (!stack.empty()) {
      const auto [node, T_object_parent] = stack.back();
      stack.pop_back();
      const Eigen::Affine3d T_object_node = T_object_parent * nodeTransform(*node);
      for (unsigned int i = 0; i < node->mNumMeshes; ++i) {
        if (!addMesh(*scene.mMeshes[node->mMeshes[i]], T_object_node)) return false;
      }
      for (unsigned int i = node->mNumChildren; i-- > 0;) stack.emplace_back(node->mChildren[i], T_object_node);
    }
    return true;
  }

  TriangleMesh takeMesh() { return std::move(mesh_); }

 private:
  using VertexKey = std::array<std::uint32_t, 3>;
  struct VertexKeyHash {
    std::size_t operator()(const VertexKey& key) const {
      std::uint64_t hash = 0;
      for (const std::uint32_t bits : key) hash = (hash ^ bits) * 0x9E3779B97F4A7C15ull, hash ^= hash >> 29;
      return static_cast<std::size_t>(hash);
    }
  };

  static Eigen::Affine3d nodeTransform(const aiNode& node) {
    const aiMatrix4x4& m = node.mTransformation;
    Eigen::Affine3d transform = Eigen::Affine3d::Identity();
    transform.affine() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4;
    return transform;
  }

  bool addMesh(const aiMesh& mesh, const Eigen::Affine3d& T_object_node) {
    for (unsigned int i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      if (face.mNumIndices != 3) continue;  // points and lines have no surface
      if (mesh_.triangles.size() >= kMaxTriangles) return false;
      std::array<std::uint32_t, 3> triangle{};
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const aiVector3D& position = mesh.mVertices[face.mIndices[corner]];
        const Eigen::Vector3d p_object = T_object_node * Eigen::Vector3d(position.x, position.y, position.z);
        triangle[corner] = vertexIndex(p_object.cast<float>());
      }
      mesh_.triangles.push_back(triangle);
    }
    return true;
  }

  std::uint32_t vertexIndex(const Eigen::Vector3f& p_object) {
    const Eigen::Vector3f position = p_object + Eigen::Vector3f::Zero();  // -0 becomes +0
    VertexKey key;
    std::memcpy(key.data(), position.data(), sizeof(key));
    const auto [entry, is_new] = index_of_.emplace(key, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (is_new) mesh_.vertices.push_back(position);
    return entry->second;
  }

  TriangleMesh mesh_;
  std::unordered_map<VertexKey, std::uint32_t, VertexKeyHash> index_of_;
};

/// assimp's PLY reader never returns from a header that does not end, and trusts the header's counts with its memory.
void checkPlyHeader(const fs::path& path, std::uintmax_t num_bytes) {
  constexpr int kMaxHeaderLines = 1000;
  const std::string name = "mesh " + path.string() + ": ";
  std::ifstream file(path, std::ios::binary);
  std::string line;
  for (int i = 0; i < kMaxHeaderLines && std::getline(file, line); ++i) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (i == 0 && line != "ply") throw MeshError(name + "cannot be read as .ply: it does not begin with the line 'ply'.");
    if (line == "end_header") return;
    std::istringstream words(line);
    std::string keyword, element;
    double count = 0.0;
    // An element takes at least one byte.
    if (words >> keyword && keyword == "element" && (!(words >> element >> count) || !(count <= static_cast<double>(num_bytes)))) {
      throw MeshError(name + "is damaged: its header says '" + line + "', the file has " + std::to_string(num_bytes) + " bytes.");
    }
  }
  throw MeshError(name + "cannot be read as .ply: its header has no line 'end_header'.");
}

/// Opening a pipe would block and a directory reads as garbage: look before.
void checkFile(const fs::path& path) {
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

TriangleMesh readTriangles(const fs::path& path, double scale) {
  Assimp::Importer importer;
  keepSupportedImporters(importer);
  importer.SetIOHandler(new SingleFileSystem(path.string()));  // owned by the importer
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = importer.ReadFile(path.string(), aiProcess_ValidateDataStructure | aiProcess_Triangulate);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    const std::string reason = importer.GetErrorString();
    throw MeshError("mesh " + path.string() + ": cannot be read as ." + lowerCaseExtension(path) + ": " +
                    (reason.empty() ? "unknown reason" : reason) + ".");
  }
  TriangleCollector collector;
  if (!collector.collect(*scene, scale)) {
    throw MeshError("mesh " + path.string() + ": has more than " + std::to_string(kMaxTriangles) +
                    " triangles; simplify the mesh first.");
  }
  return collector.takeMesh();
}

/// Importers throw whatever they like on damaged files; callers see MeshError alone.
TriangleMesh readTrianglesOrExplain(const fs::path& path, double scale) {
  const std::string name = "mesh " + path.string() + ": ";
  try {
    return readTriangles(path, scale);
  } catch (const MeshError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw MeshError(name + "there is not enough memory to read it; the file is too large or damaged.");
  } catch (const std::exception& error) {
    throw MeshError(name + "cannot be read: " + error.what() + ".");
  } catch (...) {
    throw MeshError(name + "cannot be read: the file is damaged.");
  }
}

bool isPlausibleDiameter(double diameter_m) {
  return diameter_m >= kMinMeshDiameterM && diameter_m <= kMaxMeshDiameterM;
}

/// A guess at what went wrong with the unit, from the mesh's diameter in the file's own numbers.
std::string proposeScale(double file_diameter) {
  constexpr std::array<std::pair<double, const char*>, 3> kUnits = {{{1.0, "metres"}, {0.001, "millimetres"}, {0.01, "centimetres"}}};
  for (const auto& [scale, unit] : kUnits) {
    if (isPlausibleDiameter(file_diameter * scale)) {
      return " The file is probably in " + std::string(unit) + ": try mesh_scale " + formatNumber(scale) + ".";
    }
  }
  return " Check the unit of the file and set mesh_scale to the metres per unit.";
}

void checkDiameter(const TriangleMesh& mesh, const fs::path& path, double scale) {
  const double diameter_m = diameter(mesh);
  if (isPlausibleDiameter(diameter_m)) return;
  throw MeshError("mesh " + path.string() + ": diameter is " + formatNumber(diameter_m) + " m, which is outside of [" +
                  formatNumber(kMinMeshDiameterM) + ", " + formatNumber(kMaxMeshDiameterM) + "] m; " +
                  std::to_string(mesh.triangles.size()) + " triangles were read with mesh_scale " + formatNumber(scale) +
                  "." + proposeScale(diameter_m / scale));
}

bool startsWith(const std::string& text, const std::string& prefix) { return text.compare(0, prefix.size(), prefix) == 0; }

/// `%20` -> space, as file URIs demand; anything that is no escape stays as it is.
std::string decodePercent(const std::string& text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_escape = text[i] == '%' && i + 2 < text.size() && std::isxdigit(static_cast<unsigned char>(text[i + 1])) &&
                           std::isxdigit(static_cast<unsigned char>(text[i + 2]));
    decoded += is_escape ? static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16)) : text[i];
    if (is_escape) i += 2;
  }
  return decoded;
}

std::string resolvePackageUri(const std::string& uri, const PackageResolver& resolve_package) {
  const std::string rest = uri.substr(std::strlen("package://"));
  const std::size_t slash = rest.find('/');
  const std::string package = rest.substr(0, slash);
  if (package.empty() || slash == std::string::npos || slash + 1 == rest.size()) {
    throw MeshError("mesh " + uri + ": expected package://NAME/PATH.");
  }
  if (!resolve_package) {
    throw MeshError("mesh " + uri + ": package:// names cannot be looked up here; give the file's path.");
  }
  const std::string folder = resolve_package(package);
  if (folder.empty()) {
    throw MeshError("mesh " + uri + ": package '" + package + "' was not found; is its workspace sourced (ROS_PACKAGE_PATH)?");
  }
  return folder + rest.substr(slash);
}

}  // namespace

std::string resolveMeshUri(const std::string& uri, const PackageResolver& resolve_package) {
  if (uri.empty()) throw MeshError("mesh: the path is empty.");
  if (uri.find('\0') != std::string::npos) throw MeshError("mesh: the path contains a zero byte.");
  if (startsWith(uri, "package://")) return resolvePackageUri(uri, resolve_package);
  if (startsWith(uri, "file://")) {
    std::string path = decodePercent(uri.substr(std::strlen("file://")));
    if (startsWith(path, "localhost/")) path.erase(0, std::strlen("localhost"));
    if (path.empty()) throw MeshError("mesh " + uri + ": expected file://PATH.");
    return path;
  }
  const std::size_t scheme_end = uri.find("://");
  if (scheme_end != std::string::npos) {
    throw MeshError("mesh " + uri + ": '" + uri.substr(0, scheme_end) +
                    "://' is not supported; use package://, file:// or a path.");
  }
  return uri;
}

TriangleMesh loadMesh(const std::string& uri, double scale, const PackageResolver& resolve_package) {
  const fs::path path = resolveMeshUri(uri, resolve_package);
  if (!std::isfinite(scale) || scale <= 0.0) {
    throw MeshError("mesh " + path.string() + ": mesh_scale is " + formatNumber(scale) + "; it must be finite and > 0.");
  }
  checkFile(path);
  TriangleMesh mesh = readTrianglesOrExplain(path, scale);
  const std::size_t num_read = mesh.triangles.size();
  if (num_read == 0) throw MeshError("mesh " + path.string() + ": the file has no faces.");
  removeDegenerateTriangles(mesh);
  if (mesh.triangles.empty()) {
    throw MeshError("mesh " + path.string() + ": all " + std::to_string(num_read) + " triangles are degenerate (no area).");
  }
  checkDiameter(mesh, path, scale);
  return mesh;
}

}  // namespace depth_object_tracker
