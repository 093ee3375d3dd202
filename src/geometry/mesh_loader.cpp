// SPDX-License-Identifier: BSD-3-Clause
// Mesh files to triangles in metres; assimp reads, and everything that a user may get wrong is answered here.
#include "depth_object_tracker/geometry/mesh_loader.h"

#include "mesh_file_check.h"
#include "polygon_triangulation.h"

#include <assimp/BaseImporter.h>
#include <assimp/DefaultIOStream.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <assimp/Importer.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <new>
#include <set>
#include <sstream>
#include <unordered_map>
#include <utility>

namespace depth_object_tracker {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxTriangles = 20'000'000;
constexpr std::array<const char*, 4> kExtensions = {"obj", "stl", "ply", "dae"};

std::string formatNumber(double value) {
  std::ostringstream stream;
  stream.precision(4);
  stream << value;
  return stream.str();
}

/// A parser that asks again and again for bytes behind the end of a damaged file would never return: it is stopped.
class FiniteFile : public Assimp::DefaultIOStream {
 public:
  FiniteFile(std::FILE* file, const std::string& name) : DefaultIOStream(file, name) {}
  std::size_t Read(void* buffer, std::size_t size, std::size_t count) override {
    const std::size_t num_read = DefaultIOStream::Read(buffer, size, count);
    num_empty_reads_ = num_read == 0 ? num_empty_reads_ + 1 : 0;
    if (num_empty_reads_ > kMaxEmptyReads) throw std::runtime_error("the file ends where more was expected");
    return num_read;
  }

 private:
  static constexpr int kMaxEmptyReads = 1000;
  int num_empty_reads_ = 0;
};

/// assimp may open the mesh file and nothing else: materials and textures are of no use here, and a hostile file could
/// name a device or a pipe.
class SingleFileSystem : public Assimp::DefaultIOSystem {
 public:
  explicit SingleFileSystem(std::string path) : path_(std::move(path)) {}
  bool Exists(const char* file) const override { return path_ == file; }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    std::FILE* handle = path_ == file ? std::fopen(file, mode) : nullptr;
    return handle == nullptr ? nullptr : new FiniteFile(handle, path_);
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
  /// Walks the scene graph. @throws std::runtime_error when that is more than can be handled.
  void collect(const aiScene& scene, double scale) {
    using Node = std::pair<const aiNode*, Eigen::Affine3d>;
    std::vector<Node> stack = {{scene.mRootNode, Eigen::Affine3d(Eigen::Scaling(scale))}};
    while (!stack.empty()) {
      const auto [node, T_object_parent] = stack.back();
      stack.pop_back();
      const Eigen::Affine3d T_object_node = T_object_parent * nodeTransform(*node);
      for (unsigned int i = 0; i < node->mNumMeshes; ++i) {
        addMesh(*scene.mMeshes[node->mMeshes[i]], T_object_node);
      }
      for (unsigned int i = node->mNumChildren; i-- > 0;) stack.emplace_back(node->mChildren[i], T_object_node);
    }
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

  void addMesh(const aiMesh& mesh, const Eigen::Affine3d& T_object_node) {
    for (unsigned int i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      if (face.mNumIndices < 3) continue;  // points and lines have no surface
      if (face.mNumIndices > kMaxPolygonCorners) {
        throw std::runtime_error("a face has " + std::to_string(face.mNumIndices) + " corners, more than " +
                                 std::to_string(kMaxPolygonCorners) + "; triangulate it first");
      }
      polygon_.clear();
      for (unsigned int corner = 0; corner < face.mNumIndices; ++corner) {
        const unsigned int index = face.mIndices[corner];
        if (index >= mesh.mNumVertices) throw std::runtime_error("a face names a vertex that does not exist");
        const aiVector3D& position = mesh.mVertices[index];
        polygon_.push_back(T_object_node * Eigen::Vector3d(position.x, position.y, position.z));
      }
      addPolygon();
      if (mesh_.triangles.size() > kMaxTriangles) {
        throw std::runtime_error("it has more than " + std::to_string(kMaxTriangles) +
                                 " triangles; simplify the mesh first");
      }
    }
  }

  void addPolygon() {
    const auto is_finite = [](const Eigen::Vector3d& corner) { return corner.cast<float>().allFinite(); };
    if (!std::all_of(polygon_.begin(), polygon_.end(), is_finite)) return;
    std::vector<std::uint32_t> indices;
    for (const Eigen::Vector3d& corner : polygon_) indices.push_back(vertexIndex(corner.cast<float>()));
    if (indices.size() == 3) {
      mesh_.triangles.push_back({indices[0], indices[1], indices[2]});
      return;
    }
    for (const auto& [a, b, c] : triangulatePolygon(polygon_))
      mesh_.triangles.push_back({indices[a], indices[b], indices[c]});
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
  std::vector<Eigen::Vector3d> polygon_;  // corners of the face at hand, object frame
  std::unordered_map<VertexKey, std::uint32_t, VertexKeyHash> index_of_;
};

TriangleMesh readTriangles(const fs::path& path, double scale) {
  Assimp::Importer importer;
  keepSupportedImporters(importer);
  importer.SetIOHandler(new SingleFileSystem(path.string()));  // owned by the importer
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = importer.ReadFile(path.string(), aiProcess_ValidateDataStructure);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    const std::string reason = importer.GetErrorString();
    throw MeshError("mesh " + path.string() + ": cannot be read as ." + lowerCaseExtension(path) + ": " +
                    (reason.empty() ? "unknown reason" : reason) + ".");
  }
  TriangleCollector collector;
  collector.collect(*scene, scale);
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
  constexpr std::array<std::pair<double, const char*>, 3> kUnits = {
      {{1.0, "metres"}, {0.001, "millimetres"}, {0.01, "centimetres"}}};
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
                  std::to_string(mesh.triangles.size()) + " triangles were read with mesh_scale " +
                  formatNumber(scale) + "." + proposeScale(diameter_m / scale));
}

}  // namespace

TriangleMesh loadMesh(const std::string& uri, double scale, const PackageResolver& resolve_package) {
  const fs::path path = resolveMeshUri(uri, resolve_package);
  if (!std::isfinite(scale) || scale <= 0.0) {
    throw MeshError("mesh " + path.string() + ": mesh_scale is " + formatNumber(scale) +
                    "; it must be finite and > 0.");
  }
  checkMeshFile(path);
  TriangleMesh mesh = readTrianglesOrExplain(path, scale);
  const std::size_t num_read = mesh.triangles.size();
  if (num_read == 0) throw MeshError("mesh " + path.string() + ": the file has no faces.");
  removeDegenerateTriangles(mesh);
  if (mesh.triangles.empty()) {
    throw MeshError("mesh " + path.string() + ": all " + std::to_string(num_read) +
                    " triangles are degenerate (no area).");
  }
  checkDiameter(mesh, path, scale);
  return mesh;
}

}  // namespace depth_object_tracker
