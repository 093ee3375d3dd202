// SPDX-License-Identifier: BSD-3-Clause
// assimp reads the bytes of a mesh file; its scene becomes triangles.
#include "mesh_parser.h"

#include "depth_object_tracker/geometry/mesh_loader.h"
#include "mesh_file_check.h"
#include "polygon_triangulation.h"

#include <assimp/BaseImporter.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>

#include <Eigen/Geometry>
#include <assimp/Importer.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <set>
#include <unordered_map>
#include <utility>

namespace depth_object_tracker {
namespace {

constexpr std::size_t kMaxTriangles = 20'000'000;

/// The file's bytes, as assimp reads files. A parser that asks again and again for bytes behind the end of a damaged
/// file would never return: it is stopped.
class MemoryFile : public Assimp::IOStream {
 public:
  explicit MemoryFile(const std::string& content) : content_(content) {}
  std::size_t Read(void* buffer, std::size_t size, std::size_t count) override {
    const std::size_t num_read = size == 0 ? 0 : std::min(count, (content_.size() - position_) / size);
    num_empty_reads_ = num_read == 0 ? num_empty_reads_ + 1 : 0;
    if (num_empty_reads_ > kMaxEmptyReads) throw std::runtime_error("the file ends where more was expected");
    if (num_read > 0) std::memcpy(buffer, content_.data() + position_, num_read * size);
    position_ += num_read * size;
    return num_read;
  }
  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    const std::size_t base = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? position_ : content_.size();
    if (offset > content_.size() - base) return aiReturn_FAILURE;
    position_ = base + offset;
    return aiReturn_SUCCESS;
  }
  std::size_t Tell() const override { return position_; }
  std::size_t FileSize() const override { return content_.size(); }
  void Flush() override {}

 private:
  static constexpr int kMaxEmptyReads = 1000;
  const std::string& content_;
  std::size_t position_ = 0;  // <= size
  int num_empty_reads_ = 0;
};

/// assimp gets the bytes of the mesh file and nothing else: materials and textures are of no use here, and a hostile
/// file could name a device or a pipe.
class SingleFileSystem : public Assimp::IOSystem {
 public:
  SingleFileSystem(std::string name, const std::string& content) : name_(std::move(name)), content_(content) {}
  bool Exists(const char* file) const override { return name_ == file; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char*) override {
    return name_ == file ? new MemoryFile(content_) : nullptr;
  }
  void Close(Assimp::IOStream* file) override { delete file; }

 private:
  std::string name_;
  const std::string& content_;
};

/// Without this, assimp would try its forty other formats on any file whose ending does not tell.
void keepSupportedImporters(Assimp::Importer& importer) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    Assimp::BaseImporter* format = importer.GetImporter(i);
    std::set<std::string> extensions;
    format->GetExtensionList(extensions);
    const bool is_supported = std::any_of(kMeshExtensions.begin(), kMeshExtensions.end(),
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

}  // namespace

struct MeshParser::Data {
  Data() { keepSupportedImporters(importer); }

  TriangleMesh read(const std::string& content, const std::string& extension, double scale) {
    const std::string name = "mesh." + extension;
    importer.SetIOHandler(new SingleFileSystem(name, content));  // owned by the importer
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
    const aiScene* scene = importer.ReadFile(name, aiProcess_ValidateDataStructure);
    if (scene == nullptr || scene->mRootNode == nullptr) {
      const std::string reason = importer.GetErrorString();
      if (reason.find("bad_alloc") != std::string::npos) throw std::bad_alloc();
      throw MeshError("cannot be read as ." + extension + ": " + (reason.empty() ? "unknown reason" : reason));
    }
    TriangleCollector collector;
    collector.collect(*scene, scale);
    return collector.takeMesh();
  }

  Assimp::Importer importer;
};

MeshParser::MeshParser() : data_(std::make_unique<Data>()) {}
MeshParser::~MeshParser() = default;

/// Importers throw whatever they like on damaged files; callers see MeshError alone.
TriangleMesh MeshParser::parse(const std::string& content, const std::string& extension, double scale) {
  checkMeshContent(content, extension);
  try {
    // assimp's PLY reader keeps the half-made mesh of a damaged file and would write the next file's vertices behind
    // its end: an importer that has failed is not used again.
    std::unique_ptr<Data> data = data_ ? std::move(data_) : std::make_unique<Data>();
    TriangleMesh mesh = data->read(content, extension, scale);
    data->importer.FreeScene();
    data_ = std::move(data);
    return mesh;
  } catch (const MeshError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw MeshError("there is not enough memory to read it; the file is too large or damaged");
  } catch (const std::exception& error) {
    throw MeshError(std::string("cannot be read: ") + error.what());
  } catch (...) {
    throw MeshError("cannot be read: the file is damaged");
  }
}

TriangleMesh parseMesh(const std::string& content, const std::string& extension, double scale) {
  return MeshParser().parse(content, extension, scale);
}

}  // namespace depth_object_tracker
