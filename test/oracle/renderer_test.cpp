// SPDX-License-Identifier: BSD-3-Clause
// The renderer against brute force: depth to 1e-6, the same coverage, no holes; whole, cut, near, far and hidden
// objects.
#include "depth_object_tracker/render/depth_renderer.h"

#include "depth_object_tracker/geometry/mesh_loader.h"

#include "brute_force_renderer.h"
#include "random_pose.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace depth_object_tracker {
namespace {

constexpr double kEdgeTolerancePx = 1e-4;
const PinholeCamera kCamera{80, 60, 72.3, 71.1, 38.6, 30.9};

struct Comparison {
  int num_certain_hits = 0;
  int num_uncertain = 0;
  int num_holes = 0;           ///< empty pixels inside of the object
  int num_self_occluded = 0;   ///< beams that meet another surface behind the nearest one
  double largest_error = 0.0;  ///< relative, of depth
};

/// Renders and compares every pixel of the image; failures name the pixel.
Comparison compare(DepthRenderer& renderer, const TriangleMesh& mesh, const Pose& pose, const PinholeCamera& camera) {
  std::vector<const CoveredPixel*> image(static_cast<std::size_t>(camera.width * camera.height), nullptr);
  const auto at = [&](int row, int col) -> const CoveredPixel*& {
    return image[static_cast<std::size_t>(row * camera.width + col)];
  };
  int previous = -1;
  for (const CoveredPixel& pixel : renderer.render(pose, camera)) {
    EXPECT_TRUE(pixel.row >= 0 && pixel.row < camera.height && pixel.col >= 0 && pixel.col < camera.width);
    EXPECT_GT(pixel.row * camera.width + pixel.col, previous) << "pixels come row by row, each once";
    previous = pixel.row * camera.width + pixel.col;
    at(pixel.row, pixel.col) = &pixel;
  }
  const BruteForceRenderer reference(mesh, pose, camera, kNearPlaneM);
  Comparison result;
  const auto is_covered = [&](int row, int col) { return at(row, col) != nullptr; };
  for (int row = 0; row < camera.height; ++row) {
    for (int col = 0; col < camera.width; ++col) {
      const BeamHit hit = reference.cast(row, col, kEdgeTolerancePx);
      const CoveredPixel* pixel = at(row, col);
      if (hit.is_uncertain) {
        ++result.num_uncertain;
        const bool is_inside = row > 0 && col > 0 && row + 1 < camera.height && col + 1 < camera.width &&
                               is_covered(row - 1, col) && is_covered(row + 1, col) && is_covered(row, col - 1) &&
                               is_covered(row, col + 1);
        if (pixel == nullptr && is_inside) ++result.num_holes;
        continue;
      }
      EXPECT_EQ(pixel != nullptr, std::isfinite(hit.depth))
          << "row " << row << " col " << col << " depth " << hit.depth;
      if (pixel == nullptr || !std::isfinite(hit.depth)) continue;
      ++result.num_certain_hits;
      if (std::isfinite(hit.second_depth)) ++result.num_self_occluded;
      const double error = std::abs(pixel->depth - hit.depth) / hit.depth;
      EXPECT_LT(error, 1e-6) << "row " << row << " col " << col << ": " << pixel->depth << " instead of " << hit.depth;
      const bool is_tie = hit.second_depth <= hit.depth * (1.0 + 1e-6);
      EXPECT_TRUE(is_tie || pixel->triangle == hit.triangle) << "row " << row << " col " << col;
      result.largest_error = std::max(result.largest_error, error);
    }
  }
  return result;
}

void add(Comparison& sum, const Comparison& part) {
  sum.num_certain_hits += part.num_certain_hits;
  sum.num_uncertain += part.num_uncertain;
  sum.num_holes += part.num_holes;
  sum.num_self_occluded += part.num_self_occluded;
  sum.largest_error = std::max(sum.largest_error, part.largest_error);
}

class RendererOracle : public testing::TestWithParam<const char*> {
 protected:
  RendererOracle()
      : mesh_(loadMesh(std::string(PROJECT_SOURCE_FOLDER "/meshes/") + GetParam() + ".obj")), renderer_(mesh_) {}

  /// A turned object whose surface centroid lies on the beam of a pixel.
  Pose poseAt(double u, double v, double depth_m) {
    Pose pose = Pose::Identity();
    pose.linear() = randomRotation(engine_);
    pose.translation() = depth_m * kCamera.ray(u, v) - pose.linear() * surfaceCentroid(mesh_);
    return pose;
  }
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }

  /// Few pixels may be too close to call, and none of those may be a hole.
  void expectGood(const Comparison& sum) {
    EXPECT_LE(sum.num_uncertain, 2 + sum.num_certain_hits / 100);
    EXPECT_EQ(sum.num_holes, 0);
    RecordProperty("certain_hits", sum.num_certain_hits);
    RecordProperty("uncertain", sum.num_uncertain);
    std::cout << GetParam() << ": " << sum.num_certain_hits << " pixels hit, " << sum.num_self_occluded
              << " with surface behind, " << sum.num_uncertain
              << " too close to an edge to call, largest relative error " << sum.largest_error << "\n";
  }

  TriangleMesh mesh_;
  DepthRenderer renderer_;
  std::mt19937_64 engine_{20240501};
};

TEST_P(RendererOracle, RandomPosesInFullView) {
  Comparison sum;
  for (int i = 0; i < 30; ++i)
    add(sum, compare(renderer_, mesh_, poseAt(uniform(25, 55), uniform(20, 40), uniform(0.35, 0.9)), kCamera));
  EXPECT_GT(sum.num_certain_hits, 3000);
  EXPECT_GT(sum.num_self_occluded, sum.num_certain_hits / 2) << "closed objects have a back";
  expectGood(sum);
}

TEST_P(RendererOracle, CutByEveryImageBorder) {
  Comparison sum;
  const double right = kCamera.width - 1.0, bottom = kCamera.height - 1.0;
  for (const auto& [u, v] : {std::pair{0.0, 30.0},
                             {right, 30.0},
                             {40.0, 0.0},
                             {40.0, bottom},
                             {0.0, 0.0},
                             {right, bottom},
                             {0.0, bottom},
                             {right, 0.0}}) {
    const Comparison part = compare(renderer_, mesh_, poseAt(u, v, 0.3), kCamera);
    EXPECT_GT(part.num_certain_hits, 20) << u << "," << v;
    add(sum, part);
  }
  expectGood(sum);
}

TEST_P(RendererOracle, LargerThanTheImage) {
  // A long lens: the object overflows the picture on all sides.
  PinholeCamera camera = kCamera;
  camera.fx *= 15.0;
  camera.fy *= 15.0;
  Comparison sum;
  for (int i = 0; i < 6; ++i)
    add(sum, compare(renderer_, mesh_, poseAt(kCamera.cx, kCamera.cy, uniform(0.3, 0.5)), camera));
  EXPECT_GT(sum.num_certain_hits, 6 * 80 * 60 / 4);
  expectGood(sum);
}

TEST_P(RendererOracle, AcrossTheNearPlane) {
  Comparison sum;
  int num_cut = 0;
  for (int i = 0; i < 12; ++i) {
    const Pose pose = poseAt(uniform(20, 60), uniform(15, 45), uniform(0.0, 0.1));
    double nearest = 1.0, farthest = -1.0;
    for (const Eigen::Vector3f& vertex : mesh_.vertices) {
      const double z = (pose * vertex.cast<double>()).z();
      nearest = std::min(nearest, z);
      farthest = std::max(farthest, z);
    }
    num_cut += nearest < kNearPlaneM && farthest > kNearPlaneM ? 1 : 0;
    add(sum, compare(renderer_, mesh_, pose, kCamera));
  }
  EXPECT_GE(num_cut, 6);
  EXPECT_GT(sum.num_certain_hits, 1000);
  expectGood(sum);
}

TEST_P(RendererOracle, BehindTheCameraOrBesideTheImageThereIsNothing) {
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(renderer_.render(poseAt(40, 30, -uniform(0.3, 3.0)), kCamera).empty());
    EXPECT_TRUE(renderer_.render(poseAt(-150, 30, 0.4), kCamera).empty());
    EXPECT_TRUE(renderer_.render(poseAt(40, 300, 0.4), kCamera).empty());
  }
}

TEST_P(RendererOracle, FarObjectsOfAboutOnePixel) {
  Comparison sum;
  for (int i = 0; i < 30; ++i)
    add(sum, compare(renderer_, mesh_, poseAt(uniform(5, 75), uniform(5, 55), uniform(5.0, 15.0)), kCamera));
  EXPECT_GT(sum.num_certain_hits, 5);
  expectGood(sum);
}

TEST_P(RendererOracle, SubsampledCamerasAndChangingImageSizes) {
  PinholeCamera full{160, 120, 144.6, 142.2, 77.2, 61.8};
  Comparison sum;
  for (int factor = 1; factor <= 6; ++factor) {
    PinholeCamera camera = makeSamplingGrid(full, factor).camera;
    add(sum, compare(renderer_, mesh_, poseAt(40, 30, 0.5), camera));
  }
  EXPECT_GT(sum.num_certain_hits, 500);
  expectGood(sum);
}

TEST_P(RendererOracle, WindingDoesNotMatter) {
  TriangleMesh inward = mesh_, mixed = mesh_;
  for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
    std::swap(inward.triangles[i][0], inward.triangles[i][1]);
    if (i % 3 == 0) std::swap(mixed.triangles[i][1], mixed.triangles[i][2]);
  }
  DepthRenderer inward_renderer(inward), mixed_renderer(mixed);
  for (int i = 0; i < 5; ++i) {
    const Pose pose = poseAt(40, 30, uniform(0.2, 0.8));
    const std::vector<CoveredPixel> expected = renderer_.render(pose, kCamera);
    for (DepthRenderer* renderer : {&inward_renderer, &mixed_renderer}) {
      const std::vector<CoveredPixel>& covered = renderer->render(pose, kCamera);
      ASSERT_EQ(covered.size(), expected.size());
      for (std::size_t k = 0; k < covered.size(); ++k) {
        ASSERT_EQ(covered[k].row, expected[k].row);
        ASSERT_EQ(covered[k].col, expected[k].col);
        ASSERT_NEAR(covered[k].depth, expected[k].depth, 1e-6 * expected[k].depth);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Meshes, RendererOracle, testing::Values("box", "mug", "bracket"),
                         [](const auto& test) { return std::string(test.param); });

TEST(Renderer, EmptyMeshCoversNothing) {
  EXPECT_TRUE(DepthRenderer(TriangleMesh()).render(Pose::Identity(), kCamera).empty());
}

TEST(Renderer, OpenSurfacesAreSeenFromBothSides) {
  const TriangleMesh plate{{{-0.1f, -0.1f, 0}, {0.1f, -0.1f, 0}, {0.1f, 0.1f, 0}, {-0.1f, 0.1f, 0}},
                           {{0, 1, 2}, {0, 2, 3}}};
  DepthRenderer renderer(plate);
  Pose pose = Pose::Identity();
  pose.translation().z() = 0.5;
  for (const double angle : {0.0, M_PI}) {
    pose.linear() = expSo3({0.0, angle, 0.0});
    const Comparison result = compare(renderer, plate, pose, kCamera);
    EXPECT_GT(result.num_certain_hits, 700);
    EXPECT_EQ(result.num_holes, 0);
  }
}

/// Many triangles with all corners and edges exactly on pixel centres: each centre belongs to one of them, none to
/// nobody.
TEST(Renderer, SharedEdgesOnPixelCentresLeaveNoHole) {
  const PinholeCamera camera{64, 48, 64.0, 64.0, 32.0, 24.0};
  for (const int step : {1, 2, 3, 5}) {
    for (const bool other_diagonal : {false, true}) {
      TriangleMesh mesh;
      constexpr int kCells = 6;
      for (int row = 0; row <= kCells; ++row) {
        for (int col = 0; col <= kCells; ++col) {
          mesh.vertices.emplace_back(static_cast<float>(step * col - 10) / 64.0f,
                                     static_cast<float>(step * row - 8) / 64.0f, 1.0f);
        }
      }
      for (std::uint32_t row = 0; row < kCells; ++row) {
        for (std::uint32_t col = 0; col < kCells; ++col) {
          const std::uint32_t a = row * (kCells + 1) + col, b = a + 1, c = a + kCells + 2, d = a + kCells + 1;
          if (other_diagonal) {
            mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {c, d, a}});
          } else {
            mesh.triangles.insert(mesh.triangles.end(), {{a, b, d}, {d, c, b}});
          }
        }
      }
      DepthRenderer renderer(mesh);
      std::set<std::pair<int, int>> covered;
      for (const CoveredPixel& pixel : renderer.render(Pose::Identity(), camera)) {
        EXPECT_EQ(pixel.depth, 1.0f);
        covered.emplace(pixel.row, pixel.col);
      }
      // A border belongs to one side by rule, so the square has one row and one column less than it has centres.
      EXPECT_EQ(covered.size(), static_cast<std::size_t>(step * kCells * step * kCells)) << step;
      for (int row = 1; row < step * kCells; ++row) {
        for (int col = 1; col < step * kCells; ++col)
          EXPECT_EQ(covered.count({16 + row, 22 + col}), 1u) << row << "," << col;
      }
    }
  }
}

/// The box is convex: in every row the covered pixels are one run.
TEST(Renderer, ConvexObjectsHaveNoGapsAtFullResolution) {
  const TriangleMesh mesh = loadMesh(PROJECT_SOURCE_FOLDER "/meshes/box.obj");
  DepthRenderer renderer(mesh);
  const PinholeCamera camera{640, 480, 570.0, 570.0, 319.5, 239.5};
  std::mt19937_64 engine(9);
  for (int i = 0; i < 50; ++i) {
    Pose pose = Pose::Identity();
    pose.linear() = randomRotation(engine);
    pose.translation() << 0.0, 0.0, 0.4;
    const std::vector<CoveredPixel>& covered = renderer.render(pose, camera);
    ASSERT_GT(covered.size(), 5000u);
    for (std::size_t k = 1; k < covered.size(); ++k) {
      const bool is_new_row = covered[k].row != covered[k - 1].row;
      ASSERT_TRUE(is_new_row || covered[k].col == covered[k - 1].col + 1) << "row " << covered[k].row;
    }
  }
}

TEST(Renderer, TheNearestOfManySurfacesWins) {
  // A stack of plates, drawn in an order that is neither front to back nor back to front.
  TriangleMesh mesh;
  for (const float z : {0.7f, 0.5f, 0.9f, 0.4f, 0.6f}) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {{-0.3f, -0.3f, z}, {0.3f, -0.3f, z}, {0.3f, 0.3f, z}, {-0.3f, 0.3f, z}});
    mesh.triangles.insert(mesh.triangles.end(), {{first, first + 1, first + 2}, {first, first + 2, first + 3}});
  }
  DepthRenderer renderer(mesh);
  const std::vector<CoveredPixel>& covered = renderer.render(Pose::Identity(), kCamera);
  ASSERT_FALSE(covered.empty());
  int num_nearest = 0;
  for (const CoveredPixel& pixel : covered) num_nearest += pixel.depth == 0.4f ? 1 : 0;
  EXPECT_EQ(num_nearest, static_cast<int>(covered.size()));
}

/// Two closed cubes of opposite winding that touch in a corner: neither may lose its front.
TEST(Renderer, TouchingPartsOfOppositeWinding) {
  TriangleMesh mesh;
  const auto add_cube = [&](float low, bool inward) {
    std::array<std::uint32_t, 8> corner{};
    for (std::uint32_t i = 0; i < 8; ++i) {
      const auto coordinate = [&](std::uint32_t bit) { return (i >> bit & 1) != 0 ? low + 0.1f : low; };
      const Eigen::Vector3f p(coordinate(0), coordinate(1), coordinate(2));
      if (i == 0 && !mesh.vertices.empty()) {
        corner[i] = 7;  // the first cube's last corner
      } else {
        corner[i] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(p);
      }
    }
    constexpr std::array<std::array<int, 4>, 6> kFaces = {
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    for (const auto& f : kFaces) {
      const auto c = [&](int k) {
        return corner[static_cast<std::size_t>(f[static_cast<std::size_t>(inward ? 3 - k : k)])];
      };
      mesh.triangles.push_back({c(0), c(1), c(2)});
      mesh.triangles.push_back({c(0), c(2), c(3)});
    }
  };
  add_cube(-0.1f, false);
  add_cube(0.0f, true);
  DepthRenderer renderer(mesh);
  std::mt19937_64 engine(4);
  for (int i = 0; i < 8; ++i) {
    Pose pose = Pose::Identity();
    pose.linear() = randomRotation(engine);
    pose.translation().z() = 0.5;
    EXPECT_EQ(compare(renderer, mesh, pose, kCamera).num_holes, 0);
  }
}

}  // namespace
}  // namespace depth_object_tracker
