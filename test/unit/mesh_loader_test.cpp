// SPDX-License-Identifier: BSD-3-Clause
// Loading of mesh files in every supported format, and what users are told about bad ones.
#include "depth_object_tracker/geometry/mesh_loader.h"

#include "mesh_files.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <Eigen/Geometry>

#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#if defined(__SANITIZE_ADDRESS__)
// assimp drops parts of damaged files without freeing them.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libassimp";
}
#endif

namespace depth_object_tracker {
namespace {

class MeshLoader : public testing::Test {
 protected:
  std::string load(const std::string& name, const std::string& content, double scale = 1.0) {
    return messageOf<MeshError>([&] { mesh_ = loadMesh(folder_.write(name, content), scale); });
  }
  void expectTetrahedron() {
    EXPECT_EQ(mesh_.vertices.size(), 4u);
    EXPECT_EQ(mesh_.triangles.size(), 4u);
    EXPECT_LT((boundingBox(mesh_).min - Eigen::Vector3d(0, 0, 0)).norm(), 1e-6);
    EXPECT_LT((boundingBox(mesh_).max - Eigen::Vector3d(0.1, 0.2, 0.3)).norm(), 1e-6);
  }
  static constexpr const char* kNoError = "nothing was thrown";

  TemporaryFolder folder_;
  TriangleMesh mesh_;
};

TEST_F(MeshLoader, Obj) {
  EXPECT_EQ(load("a.obj", tetrahedronObj()), kNoError);
  expectTetrahedron();
}

TEST_F(MeshLoader, ObjWithNormalsTexturesMaterialsAndUpperCaseEnding) {
  EXPECT_EQ(load("a.OBJ",
                 "mtllib a.mtl\nusemtl red\nv 0 0 0\nv 0.1 0 0\nv 0 0.2 0\nvn 0 0 1\nvn 0 1 0\nvt 0 0\nvt 1 0\n"
                 "f 1/1/1 2/2/1 3/1/1\nusemtl blue\nv 0 0 0.3\nf 1/2/2 2/1/2 4/1/2\nf -4//1 -2//1 -1//1\nf 2 3 4\n"),
            kNoError);
  expectTetrahedron();
}

TEST_F(MeshLoader, StlAscii) {
  EXPECT_EQ(load("a.stl", tetrahedronStlAscii()), kNoError);
  expectTetrahedron();
}

TEST_F(MeshLoader, StlBinary) {
  EXPECT_EQ(load("a.stl", tetrahedronStlBinary("made by a CAD program")), kNoError);
  expectTetrahedron();
}

TEST_F(MeshLoader, StlBinaryWhoseHeaderSaysSolid) {
  EXPECT_EQ(load("a.stl", tetrahedronStlBinary("solid part")), kNoError);
  expectTetrahedron();
}

TEST_F(MeshLoader, PlyAscii) {
  EXPECT_EQ(load("a.ply", tetrahedronPlyAscii()), kNoError);
  expectTetrahedron();
}

TEST_F(MeshLoader, PlyBinary) {
  EXPECT_EQ(load("a.ply", tetrahedronPlyBinary()), kNoError);
  expectTetrahedron();
}

TEST_F(MeshLoader, DaeInMetres) {
  EXPECT_EQ(load("a.dae", tetrahedronDae("1", "Y_UP", "")), kNoError);
  expectTetrahedron();
}

TEST_F(MeshLoader, DaeAppliesItsUnitAndKeepsItsAxes) {
  for (const char* up : {"X_UP", "Y_UP", "Z_UP"}) {
    EXPECT_EQ(load("a.dae", tetrahedronDae("0.5", up, "<scale>2 2 2</scale>")), kNoError);
    expectTetrahedron();
  }
}

TEST_F(MeshLoader, DaeAppliesTheSceneGraph) {
  EXPECT_EQ(load("a.dae", tetrahedronDae("1", "Z_UP", "<translate>1 2 3</translate><rotate>0 0 1 90</rotate>")),
            kNoError);
  EXPECT_LT((boundingBox(mesh_).min - Eigen::Vector3d(0.8, 2.0, 3.0)).norm(), 1e-6);
  EXPECT_LT((boundingBox(mesh_).max - Eigen::Vector3d(1.0, 2.1, 3.3)).norm(), 1e-6);
}

TEST_F(MeshLoader, ScaleTurnsMillimetresIntoMetres) {
  EXPECT_EQ(load("a.obj", tetrahedronObj(1000.0), 0.001), kNoError);
  expectTetrahedron();
}

TEST_F(MeshLoader, QuadsAndPolygonsAreTriangulated) {
  EXPECT_EQ(load("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"), kNoError);
  EXPECT_EQ(mesh_.triangles.size(), 2u);
  // An L: fans from its first corner would cover the notch.
  EXPECT_EQ(load("b.obj", "v 0 2 0\nv 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nf 1 2 3 4 5 6\n"), kNoError);
  EXPECT_EQ(mesh_.triangles.size(), 4u);
  double area = 0.0;
  for (const auto& [a, b, c] : mesh_.triangles) {
    area += 0.5 * (mesh_.vertices[b] - mesh_.vertices[a]).cross(mesh_.vertices[c] - mesh_.vertices[a]).norm();
  }
  EXPECT_NEAR(area, 3.0, 1e-6);
}

TEST_F(MeshLoader, PolygonsOfManyCornersKeepTheirArea) {
  // A star whose every second corner is concave, tilted in space.
  std::ostringstream obj;
  constexpr int kPoints = 200;
  double expected_area = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double radius = i % 2 == 0 ? 1.0 : 0.4, angle = 2.0 * M_PI * i / kPoints;
    obj << "v " << radius * std::cos(angle) << " " << radius * std::sin(angle) << " " << 0.5 * radius * std::cos(angle)
        << "\n";
    expected_area += 0.5 * 1.0 * 0.4 * std::sin(2.0 * M_PI / kPoints);
  }
  obj << "f";
  for (int i = 1; i <= kPoints; ++i) obj << " " << i;
  EXPECT_EQ(load("star.obj", obj.str() + "\n"), kNoError);
  EXPECT_EQ(mesh_.triangles.size(), kPoints - 2u);
  double area = 0.0;
  for (const auto& [a, b, c] : mesh_.triangles) {
    area += 0.5 * (mesh_.vertices[b] - mesh_.vertices[a]).cross(mesh_.vertices[c] - mesh_.vertices[a]).norm();
  }
  EXPECT_NEAR(area, expected_area * std::sqrt(1.25), 1e-4);
}

TEST_F(MeshLoader, SelfCrossingAndFlatPolygonsEndSomehow) {
  load("bow.obj", "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n");
  load("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nv 4 0 0\nf 1 2 3 4 5\n");
  EXPECT_NE(load("same.obj", "v 0 0 0\nv 1 0 0\nf 1 1 1 1 1\n"), kNoError);
}

TEST_F(MeshLoader, PolygonsOfAbsurdlyManyCornersAreRefused) {
  std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf";
  for (int i = 0; i < 2000; ++i) obj += i % 3 == 0 ? " 1" : i % 3 == 1 ? " 2" : " 3";
  EXPECT_NE(load("a.obj", obj + "\n").find("a face has 2000 corners, more than 1000"), std::string::npos);
}

TEST_F(MeshLoader, DegenerateFacesPointsAndLinesAreDropped) {
  EXPECT_EQ(load("a.obj", tetrahedronObj() + "f 1 1 2\nf 1 2\nv 0.05 0 0\nf 1 5 2\np 3\nl 1 2 3\n"), kNoError);
  EXPECT_EQ(mesh_.triangles.size(), 4u);
}

TEST_F(MeshLoader, WindingDoesNotMatter) {
  EXPECT_EQ(load("a.obj", "v 0 0 0\nv 0.1 0 0\nv 0 0.2 0\nv 0 0 0.3\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 4 3 2\n"), kNoError);
  expectTetrahedron();
}

TEST_F(MeshLoader, VerticesOnTheSamePlaceBecomeOne) {
  EXPECT_EQ(load("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -0 0 0\nv 0 1 0\nv -1 0 0\nf 1 2 3\nf 4 5 6\n"), kNoError);
  EXPECT_EQ(mesh_.vertices.size(), 4u);
}

TEST_F(MeshLoader, FileOfMillimetresIsRecognised) {
  const std::string message = load("drill.stl", tetrahedronStlBinary("", 1000.0));
  EXPECT_EQ(message,
            "mesh " + (folder_.path() / "drill.stl").string() +
                ": diameter is 360.6 m, which is outside of [0.005, 5] m; 4 triangles were read with mesh_scale 1. "
                "The file is probably in millimetres: try mesh_scale 0.001.");
}

TEST_F(MeshLoader, WrongScaleOfAFileInMetresIsRecognised) {
  const std::string message = load("a.obj", tetrahedronObj(), 0.001);
  EXPECT_NE(message.find("diameter is 0.0003606 m"), std::string::npos) << message;
  EXPECT_NE(message.find("probably in metres: try mesh_scale 1."), std::string::npos) << message;
}

TEST_F(MeshLoader, AbsurdSizeWithoutAGuess) {
  EXPECT_NE(load("a.obj", tetrahedronObj(1e9)).find("Check the unit"), std::string::npos);
}

TEST_F(MeshLoader, BadScaleIsRefused) {
  for (const double scale :
       {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_NE(load("a.obj", tetrahedronObj(), scale).find("mesh_scale is"), std::string::npos) << scale;
  }
}

TEST_F(MeshLoader, WhatIsNoMeshFileIsExplained) {
  EXPECT_NE(load("empty.obj", "").find("is empty"), std::string::npos);
  EXPECT_NE(load("a.step", "x").find("'.step' is not supported"), std::string::npos);
  EXPECT_NE(load("mesh", "x").find("is not supported"), std::string::npos);
  const std::string folder = folder_.path().string();
  EXPECT_NE(messageOf<MeshError>([&] { loadMesh(folder); }).find("is a folder"), std::string::npos);
  EXPECT_NE(messageOf<MeshError>([&] { loadMesh(folder + "/none.stl"); }).find("does not exist"), std::string::npos);
  EXPECT_NE(messageOf<MeshError>([&] { loadMesh(""); }).find("empty"), std::string::npos);
  const std::string pipe = folder + "/pipe.obj";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_NE(messageOf<MeshError>([&] { loadMesh(pipe); }).find("not a regular file"), std::string::npos);
}

TEST_F(MeshLoader, TooLargeFilesAreNotRead) {
  const std::string path = folder_.write("large.stl", "solid");
  std::filesystem::resize_file(path, std::uintmax_t{513} << 20);  // sparse: takes no space
  EXPECT_NE(messageOf<MeshError>([&] { loadMesh(path); }).find("513 MiB"), std::string::npos);
}

TEST_F(MeshLoader, MaterialsAreNotOpened) {
  // Opening this pipe would block for ever.
  ASSERT_EQ(mkfifo((folder_.path() / "a.mtl").c_str(), 0600), 0);
  EXPECT_EQ(load("a.obj", "mtllib a.mtl\n" + tetrahedronObj()), kNoError);
  expectTetrahedron();
}

TEST_F(MeshLoader, FilesWithoutSurfaceAreExplained) {
  EXPECT_NE(load("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n# nothing else at all\n"), kNoError);
  EXPECT_NE(load("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n").find("degenerate"), std::string::npos);
  EXPECT_NE(load("cloud.ply",
                 "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float "
                 "z\nend_header\n0 0 0\n"),
            kNoError);
}

TEST_F(MeshLoader, DamagedFilesGiveErrorsAndNothingWorse) {
  std::string noise;
  for (int i = 0; i < 4096; ++i) noise += static_cast<char>((i * 7919 + i * i * 31) >> 3);
  for (const char* name : {"a.obj", "a.stl", "a.ply", "a.dae"}) {
    EXPECT_NE(load(name, noise), kNoError) << name;
    EXPECT_NE(load(name, std::string(100, '\0')), kNoError) << name;
  }
  EXPECT_NE(load("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999\nf -100 -99 -98\n"), kNoError);
  EXPECT_NE(load("a.obj", "v nan 0 0\nv inf 0 0\nv 0 1 0\nf 1 2 3\n"), kNoError);
  std::string stl = tetrahedronStlBinary("");
  stl[80] = stl[81] = stl[82] = stl[83] = '\xff';  // four billion triangles
  EXPECT_NE(load("a.stl", stl), kNoError);
  std::string ply = tetrahedronPlyAscii();
  EXPECT_NE(load("a.ply", ply.replace(ply.find("vertex 4"), 8, "vertex 4000000000")), kNoError);
  ply = tetrahedronPlyAscii();
  EXPECT_NE(load("a.ply", ply.replace(ply.find("3 0 1 2"), 7, "3 0 1 9")), kNoError);
}

TEST_F(MeshLoader, DamagedDaeFilesAreExplained) {
  const auto damaged = [](const std::string& what, const std::string& with) {
    std::string dae = tetrahedronDae("1", "Z_UP", "");
    return dae.replace(dae.find(what), what.size(), with);
  };
  EXPECT_NE(load("a.dae", damaged("<p>0 1", "<p>0 x")).find("<p> holds 'x"), std::string::npos);
  EXPECT_NE(load("a.dae", damaged("<p>0 1", "<p>0 1.5")).find("<p> holds '.5"), std::string::npos);
  for (const char* other : {"", " account=\"12\"", " name=' count=\"12\"'"})
    EXPECT_NE(load("a.dae", damaged(" count=\"12\"", other)).find("<float_array> has no count"), std::string::npos);
  EXPECT_NE(load("a.dae", damaged("stride=\"3\"", "stride=\"-3\"")).find("is not a count"), std::string::npos);
  EXPECT_NE(load("a.dae", damaged("count=\"12\"", "count=\"13\"")), kNoError);
  EXPECT_NE(load("a.dae", damaged("<p>0 1", "<p>0 9")), kNoError);
  EXPECT_NE(load("a.dae", damaged("<triangles count=\"4\"", "<triangles count=\"5\"")), "");
}

TEST_F(MeshLoader, TruncatedFilesNeverCrash) {
  const std::vector<std::pair<std::string, std::string>> files = {
      {"a.obj", tetrahedronObj()},      {"b.stl", tetrahedronStlAscii()},  {"c.stl", tetrahedronStlBinary("")},
      {"d.ply", tetrahedronPlyAscii()}, {"e.ply", tetrahedronPlyBinary()}, {"f.dae", tetrahedronDae("1", "Z_UP", "")}};
  for (const auto& [name, content] : files) {
    for (std::size_t size = 1; size < content.size(); size += 7) load(name, content.substr(0, size));
  }
}

TEST_F(MeshLoader, UrisAreResolved) {
  const std::string path = folder_.write("my part.obj", tetrahedronObj());
  const auto resolver = [&](const std::string& package) {
    return package == "parts" ? folder_.path().string() : std::string();
  };
  EXPECT_EQ(loadMesh("package://parts/my part.obj", 1.0, resolver).triangles.size(), 4u);
  EXPECT_EQ(loadMesh("file://" + folder_.path().string() + "/my%20part.obj").triangles.size(), 4u);
  EXPECT_EQ(resolveMeshUri("file:///a/b%2fc.obj"), "/a/b/c.obj");
  EXPECT_EQ(resolveMeshUri("file:///a/100%.obj"), "/a/100%.obj");
  EXPECT_EQ(resolveMeshUri("file://localhost/a.obj"), "/a.obj");
  EXPECT_EQ(resolveMeshUri("some/relative.obj"), "some/relative.obj");
  EXPECT_EQ(loadMesh(path).triangles.size(), 4u);
}

TEST_F(MeshLoader, UnresolvableUrisAreExplained) {
  const auto resolver = [](const std::string&) { return std::string(); };
  const auto message = [&](const std::string& uri, const PackageResolver& resolve) {
    return messageOf<MeshError>([&] { resolveMeshUri(uri, resolve); });
  };
  EXPECT_NE(message("package://nowhere/a.obj", resolver).find("package 'nowhere' was not found"), std::string::npos);
  EXPECT_NE(message("package://parts/a.obj", {}).find("cannot be looked up here"), std::string::npos);
  EXPECT_NE(message("package://parts", resolver).find("expected package://NAME/PATH"), std::string::npos);
  EXPECT_NE(message("package:///a.obj", resolver).find("expected package://NAME/PATH"), std::string::npos);
  EXPECT_NE(message("http://host/a.obj", resolver).find("'http://' is not supported"), std::string::npos);
  EXPECT_NE(message("file://", resolver).find("expected file://PATH"), std::string::npos);
}

}  // namespace
}  // namespace depth_object_tracker
