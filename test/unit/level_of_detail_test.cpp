// SPDX-License-Identifier: BSD-3-Clause
// Simplified meshes: how near they are to the original, and that no mesh is too bad.
#include "depth_object_tracker/geometry/level_of_detail.h"

#include "depth_object_tracker/geometry/mesh_loader.h"
#include "depth_object_tracker/geometry/mesh_orientation.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <utility>

namespace depth_object_tracker {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

constexpr double kAnyError = 1.0;  // [m]

/// Grid of n x m squares, each cut in two, with the vertices where `place(u, v)` says, u and v in [0, 1].
template <typename Place>
TriangleMesh makeGrid(std::uint32_t n, std::uint32_t m, const Place& place) {
  TriangleMesh mesh;
  for (std::uint32_t j = 0; j <= m; ++j) {
    for (std::uint32_t i = 0; i <= n; ++i) {
      mesh.vertices.push_back(place(static_cast<double>(i) / n, static_cast<double>(j) / m).template cast<float>());
    }
  }
  for (std::uint32_t j = 0; j < m; ++j) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  }
  return mesh;
}

void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({a + offset, b + offset, c + offset});
}

/// Six welded grids around the origin, outward; `place` moves the points of the cube [-1, 1]^3.
template <typename Place>
TriangleMesh makeCube(std::uint32_t n, const Place& place) {
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      append(mesh, makeGrid(n, n, [&](double u, double v) {
               Eigen::Vector3d p;
               p[axis] = side;
               p[(axis + 1) % 3] = side * (2.0 * u - 1.0);  // mirrored on the negative side: outward there, too
               p[(axis + 2) % 3] = 2.0 * v - 1.0;
               return Eigen::Vector3d(place(p));
             }));
    }
  }
  return mesh;
}

TriangleMesh makeBox(std::uint32_t n, const Eigen::Vector3d& half_size) {
  return makeCube(n, [&](const Eigen::Vector3d& p) -> Eigen::Vector3d { return half_size.cwiseProduct(p); });
}

TriangleMesh makeSphere(std::uint32_t n, double radius) {
  return makeCube(n, [&](const Eigen::Vector3d& p) -> Eigen::Vector3d { return radius * p.normalized(); });
}

/// Side and both caps; vertices at the seams are there twice.
TriangleMesh makeCylinder(std::uint32_t n, std::uint32_t rings, double radius, double height) {
  const auto around = [](double u, double r, double z) {
    // The first and the last point of a circle must be the same bits.
    const double angle = u == 1.0 ? 0.0 : 2.0 * M_PI * u;
    return Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), z);
  };
  TriangleMesh mesh = makeGrid(n, rings, [&](double u, double v) { return around(u, radius, height * v); });
  append(mesh, makeGrid(n, 4, [&](double u, double v) { return around(u, radius * v, 0.0); }));
  append(mesh, makeGrid(n, 4, [&](double u, double v) { return around(u, radius * (1.0 - v), height); }));
  return mesh;
}

double signedVolume(const TriangleMesh& mesh) {
  double volume = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    volume +=
        mesh.vertices[a].cast<double>().dot(mesh.vertices[b].cast<double>().cross(mesh.vertices[c].cast<double>())) /
        6.0;
  }
  return volume;
}

double surfaceArea(const TriangleMesh& mesh) {
  double area = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    area +=
        0.5 * (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).cast<double>().norm();
  }
  return area;
}

double distanceToSegment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double along = (p - a).dot(b - a) / (b - a).squaredNorm();
  return (a + std::clamp(along, 0.0, 1.0) * (b - a) - p).norm();
}

/// Distance to the plane where the foot is inside, to the nearest side otherwise.
double distanceToTriangle(const Eigen::Vector3d& p, const TriangleMesh& mesh, const Triangle& t) {
  const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>(), b = mesh.vertices[t[1]].cast<double>(),
                        c = mesh.vertices[t[2]].cast<double>();
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const auto is_inside = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    return (to - from).cross(p - from).dot(normal) >= 0.0;
  };
  if (is_inside(a, b) && is_inside(b, c) && is_inside(c, a)) return std::abs((p - a).dot(normal.normalized()));
  return std::min({distanceToSegment(p, a, b), distanceToSegment(p, b, c), distanceToSegment(p, c, a)});
}

struct Distances {
  double rms = 0.0, max = 0.0;
};

/// From random points of one mesh to the nearest of all triangles of the other.
Distances bruteForceDistances(const TriangleMesh& from, const TriangleMesh& to, int num_points) {
  std::mt19937 engine(11);
  std::uniform_real_distribution<double> uniform;
  std::vector<double> areas;
  for (const auto& [a, b, c] : from.triangles) {
    areas.push_back((from.vertices[b] - from.vertices[a]).cross(from.vertices[c] - from.vertices[a]).norm());
  }
  std::discrete_distribution<std::size_t> pick(areas.begin(), areas.end());
  Distances distances;
  for (int i = 0; i < num_points; ++i) {
    const auto& [a, b, c] = from.triangles[pick(engine)];
    double u = uniform(engine), v = uniform(engine);
    if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
    const Eigen::Vector3d p = (1.0 - u - v) * from.vertices[a].cast<double>() + u * from.vertices[b].cast<double>() +
                              v * from.vertices[c].cast<double>();
    double nearest = std::numeric_limits<double>::infinity();
    for (const Triangle& t : to.triangles) nearest = std::min(nearest, distanceToTriangle(p, to, t));
    distances.rms += nearest * nearest / num_points;
    distances.max = std::max(distances.max, nearest);
  }
  distances.rms = std::sqrt(distances.rms);
  return distances;
}

void expectSane(const std::vector<MeshLevel>& levels, const std::string& name) {
  ASSERT_FALSE(levels.empty()) << name;
  EXPECT_EQ(levels[0].error_m, 0.0) << name;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const MeshLevel& level = levels[i];
    EXPECT_TRUE(std::isfinite(level.error_m) && std::isfinite(level.bias_m)) << name << " level " << i;
    EXPECT_LE(level.error_m, level.max_error_m) << name << " level " << i;
    std::vector<bool> is_used(level.mesh.vertices.size(), false);
    for (const Triangle& t : level.mesh.triangles) {
      for (const std::uint32_t corner : t) {
        ASSERT_LT(corner, level.mesh.vertices.size()) << name << " level " << i;
        EXPECT_TRUE(level.mesh.vertices[corner].allFinite()) << name << " level " << i;
        is_used[corner] = true;
      }
    }
    EXPECT_EQ(std::count(is_used.begin(), is_used.end(), false), 0) << name << " level " << i;
    if (i == 0) continue;
    EXPECT_LE(level.mesh.triangles.size(), 0.65 * static_cast<double>(levels[i - 1].mesh.triangles.size())) << name;
  }
}

void expectClosedAndOutward(const std::vector<MeshLevel>& levels, const std::string& name) {
  for (const MeshLevel& level : levels) {
    std::vector<Triangle> triangles = level.mesh.triangles;
    EXPECT_TRUE(orientOutward(level.mesh, triangles)) << name << ": " << triangles.size() << " triangles";
    EXPECT_EQ(triangles, level.mesh.triangles) << name << ": some triangles face inward";
    EXPECT_GT(signedVolume(level.mesh), 0.9 * signedVolume(levels[0].mesh)) << name;
  }
}

TEST(LevelOfDetail, LevelsGetCoarserAndWorse) {
  const std::vector<MeshLevel> levels = makeLevels(makeSphere(32, 0.05), kAnyError);
  expectSane(levels, "sphere");
  EXPECT_EQ(levels[0].mesh.triangles.size(), 12288u);
  EXPECT_GE(levels.size(), 10u);
  EXPECT_LE(levels.back().mesh.triangles.size(), 100u);
  EXPECT_GT(levels[levels.size() - 2].mesh.triangles.size(), 100u);
  for (std::size_t i = 1; i < levels.size(); ++i) EXPECT_GT(levels[i].error_m, levels[i - 1].error_m);
  // A regular tiling with 500 triangles has edges of 12 mm and an rms distance of about 0.1 mm.
  EXPECT_LT(levels[chooseLevel(levels, 0.00015)].mesh.triangles.size(), 600u);
}

TEST(LevelOfDetail, LargeMeshesGoToAUsefulSizeAtOnce) {
  const std::vector<MeshLevel> levels = makeLevels(makeSphere(90, 0.05), 0.00001);
  ASSERT_GE(levels.size(), 2u);
  EXPECT_GT(levels[0].mesh.triangles.size(), 90000u);
  EXPECT_LE(levels[1].mesh.triangles.size(), 50000u);
}

TEST(LevelOfDetail, ErrorIsWhatBruteForceFinds) {
  const TriangleMesh pebble = makeCube(10, [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    return Eigen::Vector3d(0.05, 0.03, 0.02).cwiseProduct(p.normalized());
  });
  const std::vector<MeshLevel> levels = makeLevels(pebble, kAnyError);
  expectSane(levels, "pebble");
  ASSERT_GE(levels.size(), 5u);
  for (std::size_t i = 1; i < levels.size(); ++i) {
    constexpr int kNumPoints = 2000;
    const Distances there = bruteForceDistances(levels[0].mesh, levels[i].mesh, kNumPoints);
    const Distances back = bruteForceDistances(levels[i].mesh, levels[0].mesh, kNumPoints);
    const double rms = std::max(there.rms, back.rms), largest = std::max(there.max, back.max);
    EXPECT_NEAR(levels[i].error_m, rms, 0.1 * rms) << i;
    EXPECT_LT(levels[i].max_error_m, 2.0 * largest) << i;
    EXPECT_GT(levels[i].max_error_m, 0.5 * largest) << i;
  }
}

TEST(LevelOfDetail, RoundBodiesDoNotShrink) {
  const std::pair<const char*, TriangleMesh> bodies[] = {{"sphere", makeSphere(40, 0.05)},
                                                         {"cylinder", makeCylinder(120, 40, 0.04, 0.12)}};
  for (const auto& [name, body] : bodies) {
    const std::vector<MeshLevel> levels = makeLevels(body, 0.0015);
    expectSane(levels, name);
    ASSERT_GE(levels.size(), 8u) << name;
    EXPECT_LT(levels.back().mesh.triangles.size(), 200u) << name;
    for (const MeshLevel& level : levels) {
      const double allowed = std::max(0.1 * level.error_m, 5e-6);
      EXPECT_LE(std::abs(level.bias_m), allowed) << name << ", " << level.mesh.triangles.size() << " triangles";
      // Measured in another way, without samples: the change of volume over the area.
      const double change = (signedVolume(level.mesh) - signedVolume(levels[0].mesh)) / surfaceArea(levels[0].mesh);
      EXPECT_LE(std::abs(change), allowed) << name << ", " << level.mesh.triangles.size() << " triangles";
    }
  }
}

TEST(LevelOfDetail, BiasIsNegativeWhereTheSurfaceShrank) {
  // 12 triangles cannot follow a dented box of many: the bias has a sign that can be told from the volume.
  const TriangleMesh star = makeCube(16, [](const Eigen::Vector3d& p) {
    return Eigen::Vector3d(0.05 * p.normalized() * (1.0 + 0.3 * std::sin(9.0 * p.x()) * std::sin(9.0 * p.y())));
  });
  const std::vector<MeshLevel> levels = makeLevels(star, kAnyError);
  int num_compared = 0;
  for (const MeshLevel& level : levels) {
    const double change = (signedVolume(level.mesh) - signedVolume(levels[0].mesh)) / surfaceArea(levels[0].mesh);
    if (std::abs(change) < 0.0002) continue;
    EXPECT_GT(level.bias_m * change, 0.0) << level.mesh.triangles.size();
    ++num_compared;
  }
  EXPECT_GE(num_compared, 1);
}

TEST(LevelOfDetail, ClosedMeshesStayClosedAndFaceOutward) {
  TriangleMesh inward = makeSphere(16, 0.05);
  for (Triangle& t : inward.triangles) std::swap(t[0], t[1]);
  std::vector<std::pair<std::string, TriangleMesh>> meshes = {{"sphere", makeSphere(24, 0.05)},
                                                              {"cylinder", makeCylinder(64, 20, 0.04, 0.12)},
                                                              {"plate", makeBox(16, {0.1, 0.05, 0.0005})},
                                                              {"inward", inward}};
  for (const std::string name : {"drill", "mug", "bottle", "bracket", "spatula"}) {
    meshes.emplace_back(name, loadMesh(PROJECT_SOURCE_FOLDER "/meshes/" + name + ".obj"));
  }
  for (const auto& [name, mesh] : meshes) {
    const std::vector<MeshLevel> levels = makeLevels(mesh, 0.0005);
    expectSane(levels, name);
    EXPECT_GE(levels.size(), 4u) << name;
    expectClosedAndOutward(levels, name);
  }
}

TEST(LevelOfDetail, ThinRingsKeepTheirTopology) {
  // A wavy wire with three corners around it: collapsing an edge between these would cost little, and cut the wire.
  const TriangleMesh ring = makeGrid(200, 3, [](double u, double v) -> Eigen::Vector3d {
    const double a = u == 1.0 ? 0.0 : 2.0 * M_PI * u, b = v == 1.0 ? 0.0 : 2.0 * M_PI * v;
    const double r = 0.05 + 0.0002 * std::sin(20.0 * a) + 0.00015 * std::cos(b);
    return {r * std::cos(a), r * std::sin(a), 0.00015 * std::sin(b)};
  });
  const std::vector<MeshLevel> levels = makeLevels(ring, kAnyError);
  expectSane(levels, "ring");
  EXPECT_GE(levels.size(), 4u);
  for (const MeshLevel& level : levels) {
    if (level.mesh.triangles.size() < 150) break;  // too few for the ring: pieces may merge or come apart
    EXPECT_EQ(2 * level.mesh.vertices.size(), level.mesh.triangles.size()) << "Euler characteristic of a torus is 0";
  }
}

TEST(LevelOfDetail, NoTriangleFoldsOver) {
  // Bumps smaller than the triangles of the coarse levels.
  const TriangleMesh golf_ball = makeCube(40, [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    const Eigen::Vector3d n = p.normalized();
    return (0.05 + 0.0003 * std::sin(60.0 * n.x()) * std::sin(60.0 * n.y()) * std::sin(60.0 * n.z())) * n;
  });
  double turned_over_sum = 0.0;  // over all levels
  for (const MeshLevel& level : makeLevels(golf_ball, kAnyError)) {
    double turned_over = 0.0;  // [m^2]
    for (const auto& [a, b, c] : level.mesh.triangles) {
      const Eigen::Vector3f &p = level.mesh.vertices[a], &q = level.mesh.vertices[b], &r = level.mesh.vertices[c];
      const Eigen::Vector3f area_vector = 0.5f * (q - p).cross(r - p);
      if (area_vector.dot(p + q + r) <= 0.0f) turned_over += area_vector.norm();
    }
    turned_over_sum += turned_over / surfaceArea(level.mesh);
  }
  EXPECT_LT(turned_over_sum, 6e-5) << "more than a few needles";
}

TEST(LevelOfDetail, BoxesStayExact) {
  const TriangleMesh box = makeBox(1, {0.05, 0.1, 0.025});
  const std::vector<MeshLevel> only = makeLevels(box, kAnyError);
  ASSERT_EQ(only.size(), 1u);
  EXPECT_EQ(only[0].mesh.triangles.size(), 12u);
  EXPECT_EQ(only[0].mesh.vertices.size(), 8u);
  EXPECT_NEAR(signedVolume(only[0].mesh), 0.001, 1e-9);

  const std::vector<MeshLevel> levels = makeLevels(makeBox(32, {0.05, 0.1, 0.025}), kAnyError);
  expectSane(levels, "fine box");
  EXPECT_LE(levels.back().mesh.triangles.size(), 100u);
  for (const MeshLevel& level : levels) {
    EXPECT_LT(level.max_error_m, 1e-6) << level.mesh.triangles.size();
    EXPECT_NEAR(signedVolume(level.mesh), 0.001, 1e-9) << level.mesh.triangles.size();
  }
}

TEST(LevelOfDetail, TheFirstLevelIsTheOriginalWelded) {
  const TriangleMesh sphere = makeSphere(8, 0.05);
  TriangleMesh unwelded;
  for (const Triangle& t : sphere.triangles) {
    const auto first = static_cast<std::uint32_t>(unwelded.vertices.size());
    for (const std::uint32_t corner : t) unwelded.vertices.push_back(sphere.vertices[corner]);
    unwelded.triangles.push_back({first, first + 1, first + 2});
  }
  unwelded.vertices.emplace_back(1.0f, 1.0f, 1.0f);
  const std::vector<MeshLevel> levels = makeLevels(unwelded, kAnyError);
  expectSane(levels, "unwelded");
  EXPECT_EQ(levels[0].mesh.triangles.size(), sphere.triangles.size());
  EXPECT_EQ(levels[0].mesh.vertices.size(), 6u * 8u * 8u + 2u);
  EXPECT_GE(levels.size(), 3u);
  for (std::size_t i = 0; i < sphere.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(levels[0].mesh.vertices[levels[0].mesh.triangles[i][k]], sphere.vertices[sphere.triangles[i][k]]);
    }
  }
}

TEST(LevelOfDetail, OpenSurfacesKeepTheirBorder) {
  const TriangleMesh sheet =
      makeGrid(50, 50, [](double u, double v) { return Eigen::Vector3d(0.2 * u, 0.1 * v, 0.02 * std::sin(3.0 * u)); });
  const std::vector<MeshLevel> levels = makeLevels(sheet, 0.0002);
  expectSane(levels, "sheet");
  EXPECT_GE(levels.size(), 6u);
  for (const MeshLevel& level : levels) {
    EXPECT_EQ(level.bias_m, 0.0);
    const BoundingBox box = boundingBox(level.mesh);
    EXPECT_NEAR(box.min.x(), 0.0, 0.0005);
    EXPECT_NEAR(box.max.x(), 0.2, 0.0005);
    EXPECT_NEAR(box.max.y(), 0.1, 0.0005);
    EXPECT_NEAR(surfaceArea(level.mesh), surfaceArea(levels[0].mesh), 0.005 * surfaceArea(levels[0].mesh));
  }
}

TEST(LevelOfDetail, BadMeshesSurvive) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  std::mt19937 engine(5);
  std::normal_distribution<float> noise(0.0f, 0.001f);

  EXPECT_EQ(makeLevels({}, kAnyError).size(), 1u);
  EXPECT_TRUE(makeLevels({{{0, 0, 0}, {nan, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 0, 2}, {0, 1, 9}}}, kAnyError)[0]
                  .mesh.triangles.empty());

  TriangleMesh damaged = makeSphere(16, 0.05);
  damaged.vertices[40] = {nan, 0, 0};
  damaged.vertices[90] = {infinity, 0, 0};
  damaged.triangles.insert(damaged.triangles.end(), {{0, 1, 4000000000u}, {3, 3, 4}, {5, 6, 5}});
  std::vector<std::pair<const char*, TriangleMesh>> meshes = {{"damaged", damaged}};

  TriangleMesh fin = makeCylinder(48, 30, 0.04, 0.12);  // three triangles at each edge where the fin begins
  append(fin, makeGrid(4, 30, [](double u, double v) { return Eigen::Vector3d(0.04 + 0.02 * u, 0.0, 0.12 * v); }));
  meshes.emplace_back("fin", fin);

  TriangleMesh soup;  // loose triangles
  const TriangleMesh sphere = makeSphere(16, 0.05);
  for (const Triangle& t : sphere.triangles) {
    TriangleMesh loose{{sphere.vertices[t[0]], sphere.vertices[t[1]], sphere.vertices[t[2]]}, {{0, 1, 2}}};
    for (Eigen::Vector3f& vertex : loose.vertices) vertex.x() += 0.01f * noise(engine);
    append(soup, loose);
  }
  meshes.emplace_back("soup", soup);

  TriangleMesh crumpled = makeSphere(20, 0.05);  // noise larger than the triangles, cracks along the cube's edges
  for (Eigen::Vector3f& vertex : crumpled.vertices) {
    vertex += 5.0f * Eigen::Vector3f(noise(engine), noise(engine), noise(engine));
  }
  meshes.emplace_back("crumpled", crumpled);

  TriangleMesh twice = makeSphere(16, 0.05);  // every triangle there twice, the second time inside out
  for (std::size_t i = 0, count = twice.triangles.size(); i < count; ++i) {
    const Triangle t = twice.triangles[i];
    twice.triangles.push_back({t[1], t[0], t[2]});
  }
  meshes.emplace_back("twice", twice);

  TriangleMesh random;  // any corners
  std::uniform_int_distribution<std::uint32_t> corner(0, 99);
  for (int i = 0; i < 100; ++i) random.vertices.emplace_back(noise(engine), noise(engine), noise(engine));
  for (int i = 0; i < 600; ++i) random.triangles.push_back({corner(engine), corner(engine), corner(engine)});
  meshes.emplace_back("random", random);

  TriangleMesh crumbs = makeSphere(20, 0.05);  // a scan with many loose pieces around it
  for (int i = 0; i < 200; ++i) {
    TriangleMesh crumb = makeBox(1, {0.0002, 0.0002, 0.0002});
    const Eigen::Vector3f centre = 0.052f * Eigen::Vector3f(noise(engine), noise(engine), noise(engine)).normalized();
    for (Eigen::Vector3f& vertex : crumb.vertices) vertex += centre;
    append(crumbs, crumb);
  }
  meshes.emplace_back("crumbs", crumbs);

  EXPECT_EQ(makeLevels(soup, kAnyError).size(), 1u) << "fewer loose triangles would leave holes";
  for (const auto& [name, mesh] : meshes) expectSane(makeLevels(mesh, kAnyError), name);
  EXPECT_GE(makeLevels(crumbs, kAnyError).size(), 5u) << "loose pieces must not stand in the way";
}

TEST(LevelOfDetail, SameMeshGivesTheSameBytes) {
  TriangleMesh mesh = makeSphere(24, 0.05);
  std::mt19937 engine(5);
  std::normal_distribution<float> noise(0.0f, 0.0003f);
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex.z() += noise(engine);
  const std::vector<MeshLevel> first = makeLevels(mesh, kAnyError), second = makeLevels(mesh, kAnyError);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].mesh.triangles, second[i].mesh.triangles);
    ASSERT_EQ(first[i].mesh.vertices.size(), second[i].mesh.vertices.size());
    EXPECT_EQ(std::memcmp(first[i].mesh.vertices.data(), second[i].mesh.vertices.data(),
                          sizeof(Eigen::Vector3f) * first[i].mesh.vertices.size()),
              0);
    EXPECT_EQ(first[i].error_m, second[i].error_m);
    EXPECT_EQ(first[i].bias_m, second[i].bias_m);
  }
}

TEST(LevelOfDetail, NoLevelIsWorseThanAllowed) {
  const TriangleMesh sphere = makeSphere(24, 0.05);
  const std::vector<MeshLevel> levels = makeLevels(sphere, 0.0002);
  EXPECT_GE(levels.size(), 3u);
  for (const MeshLevel& level : levels) EXPECT_LE(level.error_m, 0.0002);
  EXPECT_GT(makeLevels(sphere, kAnyError).size(), levels.size());
  EXPECT_EQ(makeLevels(sphere, 0.0).size(), 1u);
  EXPECT_EQ(makeLevels(sphere, -1.0).size(), 1u);
  EXPECT_EQ(makeLevels(sphere, std::numeric_limits<double>::quiet_NaN()).size(), 1u);
}

TEST(LevelOfDetail, CoarsestGoodEnoughLevelIsChosen) {
  std::vector<MeshLevel> levels(4);
  levels[1].error_m = 0.001;
  levels[2].error_m = 0.003;
  levels[3].error_m = 0.002;
  EXPECT_EQ(chooseLevel(levels, 0.0), 0u);
  EXPECT_EQ(chooseLevel(levels, 0.0009), 0u);
  EXPECT_EQ(chooseLevel(levels, 0.001), 1u);
  EXPECT_EQ(chooseLevel(levels, 0.0025), 3u);
  EXPECT_EQ(chooseLevel(levels, 1.0), 3u);
  EXPECT_EQ(chooseLevel(levels, -1.0), 0u);
  EXPECT_EQ(chooseLevel(levels, std::numeric_limits<double>::quiet_NaN()), 0u);
  EXPECT_EQ(chooseLevel({}, 1.0), 0u);
}

}  // namespace
}  // namespace depth_object_tracker
