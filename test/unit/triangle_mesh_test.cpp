// SPDX-License-Identifier: BSD-3-Clause
// Box, diameter, centroid and clean-up of meshes.
#include "depth_object_tracker/geometry/triangle_mesh.h"

#include "depth_object_tracker/geometry/mesh_loader.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <limits>
#include <random>

namespace depth_object_tracker {
namespace {

TriangleMesh unitSquare() {
  return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

TEST(TriangleMesh, EmptyMeshHasNoSize) {
  EXPECT_EQ(boundingBox({}).size().norm(), 0.0);
  EXPECT_EQ(diameter({}), 0.0);
  EXPECT_EQ(surfaceCentroid({}), Eigen::Vector3d::Zero());
}

TEST(TriangleMesh, UnusedVerticesDoNotCount) {
  TriangleMesh mesh = unitSquare();
  mesh.vertices.emplace_back(100.0f, 100.0f, 100.0f);
  EXPECT_EQ(boundingBox(mesh).min, Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(boundingBox(mesh).max, Eigen::Vector3d(1, 1, 0));
  EXPECT_NEAR(diameter(mesh), std::sqrt(2.0), 1e-7);
  EXPECT_LT((surfaceCentroid(mesh) - Eigen::Vector3d(0.5, 0.5, 0.0)).norm(), 1e-12);
}

TEST(TriangleMesh, CentroidDoesNotDependOnTheCut) {
  // A right half cut into many more triangles than the left one.
  TriangleMesh mesh;
  constexpr int kStrips = 64;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  for (int i = 0; i <= kStrips; ++i) {
    mesh.vertices.emplace_back(1.0f + static_cast<float>(i) / kStrips, 0.0f, 0.0f);
    mesh.vertices.emplace_back(1.0f + static_cast<float>(i) / kStrips, 1.0f, 0.0f);
  }
  for (std::uint32_t i = 4; i + 3 < mesh.vertices.size(); i += 2) {
    mesh.triangles.push_back({i, i + 1, i + 2});
    mesh.triangles.push_back({i + 2, i + 1, i + 3});
  }
  EXPECT_LT((surfaceCentroid(mesh) - Eigen::Vector3d(1.0, 0.5, 0.0)).norm(), 1e-6);
}

TEST(TriangleMesh, CentroidOfZeroAreaIsTheBoxCentre) {
  const TriangleMesh line{{{0, 0, 0}, {1, 0, 0}, {4, 0, 0}}, {{0, 1, 2}}};
  EXPECT_LT((surfaceCentroid(line) - Eigen::Vector3d(2, 0, 0)).norm(), 1e-12);
}

TEST(TriangleMesh, DiameterIsWithinOnePercentOfAllPairs) {
  std::mt19937 engine(3);
  std::normal_distribution<float> normal;
  for (int trial = 0; trial < 20; ++trial) {
    // Clouds of all shapes: flat, long, round.
    const Eigen::Vector3f stretch(std::abs(normal(engine)), std::abs(normal(engine)), std::abs(normal(engine)));
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < 300; ++i) {
      mesh.vertices.push_back(stretch.cwiseProduct(Eigen::Vector3f(normal(engine), normal(engine), normal(engine))));
      if (i >= 2) mesh.triangles.push_back({i - 2, i - 1, i});
    }
    double exact = 0.0;
    for (const auto& a : mesh.vertices) {
      for (const auto& b : mesh.vertices) exact = std::max(exact, (a.cast<double>() - b.cast<double>()).norm());
    }
    EXPECT_LE(diameter(mesh), exact * (1.0 + 1e-12));
    EXPECT_GE(diameter(mesh), 0.99 * exact);
  }
}

TEST(TriangleMesh, DegenerateTrianglesGoAndTheOthersStay) {
  TriangleMesh mesh = unitSquare();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  mesh.vertices.insert(mesh.vertices.end(), {{nan, 0, 0}, {0.5f, 0.5f, 0}, {0, 0, 0}, {0.5f, 1e-9f, 0}});
  mesh.triangles.insert(mesh.triangles.end(), {{0, 0, 1}, {0, 1, 99}, {0, 1, 4}, {0, 5, 2}, {0, 6, 2}, {0, 7, 1}});
  EXPECT_EQ(removeDegenerateTriangles(mesh), 6u);
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
  EXPECT_EQ(mesh.triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
  EXPECT_EQ(removeDegenerateTriangles(mesh), 0u);
}

TEST(TriangleMesh, ThinAndSmallTrianglesOfRealMeshesStay) {
  // A facet of a 1 mm wire, 1 m long, beside a fine triangle of a scan.
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {1, 0.0001f, 0}, {0.5f, 0.5f, 0}, {0.50001f, 0.5f, 0}, {0.5f, 0.50001f, 0}},
                    {{0, 1, 2}, {3, 4, 5}}};
  EXPECT_EQ(removeDegenerateTriangles(mesh), 0u);
}

TEST(TriangleMesh, BadIndicesDoNotHarmAnyFunction) {
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 1, 4000000000u}}};
  EXPECT_NEAR(diameter(mesh), std::sqrt(2.0), 1e-7);
  EXPECT_NEAR(boundingBox(mesh).size().x(), 1.0, 1e-12);
  EXPECT_TRUE(surfaceCentroid(mesh).allFinite());
}

TEST(ShippedMeshes, LoadAndAreClosed) {
  for (const char* name : {"drill", "mug", "box", "bottle", "bracket", "spatula"}) {
    const TriangleMesh mesh = loadMesh(std::string(PROJECT_SOURCE_FOLDER "/meshes/") + name + ".obj");
    EXPECT_GT(diameter(mesh), 0.1) << name;
    EXPECT_LT(diameter(mesh), 0.4) << name;
    // Every edge has as many triangles on one side as on the other: area vectors of a closed surface cancel.
    Eigen::Vector3d area = Eigen::Vector3d::Zero();
    double volume = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
      const Eigen::Vector3d p = mesh.vertices[a].cast<double>(), q = mesh.vertices[b].cast<double>(),
                            r = mesh.vertices[c].cast<double>();
      area += (q - p).cross(r - p) / 2.0;
      volume += p.dot(q.cross(r)) / 6.0;
    }
    EXPECT_LT(area.norm(), 1e-7) << name;
    EXPECT_GT(volume, 1e-5) << name << ": winding must be outward";
  }
}

}  // namespace
}  // namespace depth_object_tracker
