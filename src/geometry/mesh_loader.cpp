// SPDX-License-Identifier: BSD-3-Clause
// Mesh files to triangles in metres; everything that a user may get wrong is answered here.
#include "depth_object_tracker/geometry/mesh_loader.h"

#include "mesh_file_check.h"
#include "mesh_parser.h"
#include "mesh_source.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <utility>

namespace depth_object_tracker {
namespace {

namespace fs = std::filesystem;

std::string formatNumber(double value) {
  std::ostringstream stream;
  stream.precision(4);
  stream << value;
  return stream.str();
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

void checkDiameter(const TriangleMesh& mesh, double scale) {
  const double diameter_m = diameter(mesh);
  if (isPlausibleDiameter(diameter_m)) return;
  throw MeshError("diameter is " + formatNumber(diameter_m) + " m, which is outside of [" +
                  formatNumber(kMinMeshDiameterM) + ", " + formatNumber(kMaxMeshDiameterM) + "] m; " +
                  std::to_string(mesh.triangles.size()) + " triangles were read with mesh_scale " +
                  formatNumber(scale) + "." + proposeScale(diameter_m / scale));
}

void checkScale(double scale) {
  if (std::isfinite(scale) && scale > 0.0) return;
  throw MeshError("mesh_scale is " + formatNumber(scale) + "; it must be finite and > 0");
}

/// From what a file has to what a tracker can use.
void finishMesh(TriangleMesh& mesh, double scale) {
  const std::size_t num_read = mesh.triangles.size();
  if (num_read == 0) throw MeshError("the file has no faces");
  removeDegenerateTriangles(mesh);
  if (mesh.triangles.empty()) {
    throw MeshError("all " + std::to_string(num_read) + " triangles are degenerate (no area)");
  }
  checkDiameter(mesh, scale);
}

}  // namespace

TriangleMesh loadMeshFrom(const std::string& uri, double scale, const FileAccess& access,
                          const PackageResolver& resolve_package, const FileParser& parse) {
  const fs::path path = resolveMeshUri(uri, resolve_package);
  try {
    checkScale(scale);
    const InputFile file(path, kMaxMeshFileBytes, access.with(packageFolder(uri, resolve_package)));
    const std::string extension = meshExtension(path);
    if (file.size() == 0) throw MeshError("the file is empty");
    TriangleMesh mesh = parse(file, extension, scale);
    finishMesh(mesh, scale);
    return mesh;
  } catch (const std::exception& error) {
    const std::string what = error.what();
    throw MeshError("mesh " + path.string() + ": " + what + (what.empty() || what.back() != '.' ? "." : ""));
  }
}

TriangleMesh loadMesh(const std::string& uri, double scale, const PackageResolver& resolve_package) {
  return loadMeshFrom(uri, scale, FileAccess(), resolve_package,
                      [](const InputFile& file, const std::string& extension, double file_scale) {
                        return parseMesh(file.read(), extension, file_scale);
                      });
}

}  // namespace depth_object_tracker
