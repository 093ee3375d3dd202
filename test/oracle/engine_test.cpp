// SPDX-License-Identifier: BSD-3-Clause
// The engine that evaluates poses: every instruction set against the plain C++ reference, to the byte, and that against
// exact rendering and the double-precision measurement model.
#include "depth_object_tracker/filter/occlusion_tiles.h"
#include "depth_object_tracker/filter/tile_likelihood.h"
#include "depth_object_tracker/geometry/mesh_loader.h"
#include "depth_object_tracker/geometry/simd_target.h"
#include "depth_object_tracker/model/fast_math.h"
#include "depth_object_tracker/model/pixel_likelihood.h"
#include "depth_object_tracker/render/depth_renderer.h"
#include "depth_object_tracker/render/tile_renderer.h"

#include "brute_force_renderer.h"
#include "plate_scene.h"
#include "random_pose.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <limits>
#include <new>
#include <optional>
#include <string>
#include <vector>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define COUNTS_ALLOCATIONS 0  // sanitizers bring their own operator new
#else
#define COUNTS_ALLOCATIONS 1
#endif

namespace {
std::atomic<std::size_t> num_allocations{0};
}  // namespace

#if COUNTS_ALLOCATIONS
// Inlined, free() would look to the compiler as if it did not belong to operator new.
#define NOINLINE __attribute__((noinline))
NOINLINE void* operator new(std::size_t size) {
  ++num_allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
NOINLINE void* operator new(std::size_t size, std::align_val_t alignment) {
  ++num_allocations;
  const auto bytes = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(bytes, (size + bytes - 1) / bytes * bytes)) return memory;
  throw std::bad_alloc();
}
NOINLINE void operator delete(void* memory) noexcept {
  std::free(memory);
}
NOINLINE void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
NOINLINE void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
NOINLINE void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
#endif

namespace depth_object_tracker {
namespace {

constexpr float kEmpty = std::numeric_limits<float>::infinity();
constexpr int kPosesPerFactor = 50;
constexpr double kEdgeStddevs[] = {0.0, 0.3, 0.85};  // of which the outline reaches 0, 1 and 2 pixels
// No multiple of a tile's size, nor are its subsampled versions.
const PinholeCamera kFullCamera{317, 243, 290.0, 288.0, 158.7, 121.3};

PinholeCamera cameraAt(int factor) {
  return makeSamplingGrid(kFullCamera, factor).camera;
}

CellBox imageOf(const PinholeCamera& camera) {
  return {0, camera.height, 0, camera.width};
}

/// "open_mug" is the mug with holes: no outside, both sides are seen.
TriangleMesh loadNamed(const std::string& name) {
  const bool open = name == "open_mug";
  TriangleMesh mesh = loadMesh(PROJECT_SOURCE_FOLDER "/meshes/" + (open ? "mug" : name) + ".obj");
  if (!open) return mesh;
  const auto triangles = mesh.triangles;
  mesh.triangles.clear();
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (i % 7 != 0) mesh.triangles.push_back(triangles[i]);
  }
  return mesh;
}

/// Restores the instruction set at the end of a test.
class WithTargets : public testing::Test {
 protected:
  ~WithTargets() override { selectSimdTarget("auto"); }

  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }

  template <typename Function>
  static void forEachTarget(const Function& function) {
    for (const std::string& target : availableSimdTargets()) {
      ASSERT_TRUE(selectSimdTarget(target));
      ASSERT_EQ(simdTarget(), target);
      SCOPED_TRACE(target);
      function();
    }
  }

  std::mt19937_64 engine_{20250117};
};

class EngineOracle : public WithTargets, public testing::WithParamInterface<const char*> {
 protected:
  EngineOracle() : object_(loadNamed(GetParam())) {}

  double nearestCorner(const Pose& pose) const {
    double nearest = 1e9;
    for (const Eigen::Vector3f& vertex : object_.mesh.vertices) {
      nearest = std::min(nearest, (pose * vertex.cast<double>()).z());
    }
    return nearest;
  }

  /// A turned object whose surface centroid lies on the beam of a full-resolution pixel.
  Pose poseAtPixel(double u, double v, double depth_m) {
    Pose pose = Pose::Identity();
    pose.linear() = randomRotation(engine_);
    pose.translation() = depth_m * kFullCamera.ray(u, v) - pose.linear() * surfaceCentroid(object_.mesh);
    return pose;
  }

  /// Beyond the near plane: in full view, cut by a border of the image, very near, and far.
  Pose randomView(int index) {
    const double width = kFullCamera.width, height = kFullCamera.height;
    const double u = uniform(0.3, 0.7) * width, v = uniform(0.3, 0.7) * height;
    if (index % 5 == 1) return beyondNearPlane(poseAtPixel(index % 2 == 0 ? 0.0 : width, v, uniform(0.3, 0.6)), 0.1);
    if (index % 5 == 2) return beyondNearPlane(poseAtPixel(u, index % 2 == 0 ? 0.0 : height, uniform(0.3, 0.6)), 0.1);
    if (index % 5 == 3) return beyondNearPlane(poseAtPixel(u, v, 0.15), 0.06);
    if (index % 5 == 4) return poseAtPixel(u, v, 3.0);
    return beyondNearPlane(poseAtPixel(u, v, uniform(0.4, 1.2)), 0.1);
  }

  Pose beyondNearPlane(Pose pose, double nearest_m) const {
    pose.translation().z() += std::max(0.0, nearest_m - nearestCorner(pose));
    return pose;
  }

  /// An empty tile for a pose. What a stage has to write holds a value that no stage writes.
  DepthTile emptyTile(const Pose& pose, const PinholeCamera& camera, float poison) const {
    DepthTile tile;
    tile.clear(TileRenderer::coveredBox(object_, pose, camera), imageOf(camera));
    poisonAllButDepth(tile, poison);
    return tile;
  }

  static void poisonAllButDepth(DepthTile& tile, float poison) {
    const int cells = tile.tile_rows * kTileSize * tile.stride;
    for (float* plane : {tile.softDepth(), tile.coverage(), tile.distance(), tile.dilated(), tile.eroded()}) {
      std::fill(plane - DepthTile::kPad, plane - DepthTile::kPad + cells, poison);
    }
    std::fill(tile.face() - DepthTile::kPad, tile.face() - DepthTile::kPad + cells, -1);
  }

  DepthTile drawScalar(const FaceSet& faces, const Pose& pose, const PinholeCamera& camera) const {
    DepthTile tile = emptyTile(pose, camera, 3.5f);
    rasterizeScalar(faces, RasterTransform(pose, camera, tile), tile);
    return tile;
  }

  /// Calls function(factor, index, pose) for the same poses at every sampling of the image.
  template <typename Function>
  void forEachView(const Function& function) {
    for (const int factor : {1, 3, 5}) {
      for (int i = 0; i < kPosesPerFactor; ++i) {
        const Pose pose = randomView(i);
        SCOPED_TRACE("factor " + std::to_string(factor) + ", pose " + std::to_string(i));
        function(cameraAt(factor), i, pose);
        if (HasFatalFailure()) return;
      }
    }
  }

  RenderObject object_;
};
INSTANTIATE_TEST_SUITE_P(Meshes, EngineOracle, testing::Values("drill", "mug", "box", "bottle", "bracket", "open_mug"),
                         [](const auto& test) { return std::string(test.param); });

/// Closed surfaces only.
class ClosedMesh : public EngineOracle {};
INSTANTIATE_TEST_SUITE_P(Meshes, ClosedMesh, testing::Values("drill", "mug", "box", "bottle", "bracket"),
                         [](const auto& test) { return std::string(test.param); });

int countCovered(const DepthTile& tile) {
  int count = 0;
  for (int row = 0; row < tile.rows; ++row) {
    const float* depth = tile.depth() + row * tile.stride;
    count += static_cast<int>(std::count_if(depth, depth + tile.cols, [](float value) { return value < kEmpty; }));
  }
  return count;
}

bool sameBytes(const float* a, const float* b, int count) {
  return std::memcmp(a, b, static_cast<std::size_t>(count) * sizeof(float)) == 0;
}

/// First row in which the planes differ in columns [begin, end); -1 = none.
int firstDifferentRow(const DepthTile& tile, const float* a, const float* b, int begin, int end) {
  for (int row = 0; row < tile.rows; ++row) {
    if (!sameBytes(a + row * tile.stride + begin, b + row * tile.stride + begin, end - begin)) return row;
  }
  return -1;
}

/// One face of a set, with its own id.
FaceSet onlyFace(const FaceSet& all, std::int32_t id) {
  FaceSet one;
  one.count = 1;
  one.padded = FaceSet::kPadding;
  one.faces_outward = all.faces_outward;
  const auto i = static_cast<std::size_t>(id);
  const auto take = [&](const auto& from, auto& to) {
    to.assign(FaceSet::kPadding, 0);
    to[0] = from[i];
  };
  for (std::size_t k = 0; k < 3; ++k) {
    take(all.ax[k], one.ax[k]);
    take(all.bx[k], one.bx[k]);
    take(all.cx[k], one.cx[k]);
    take(all.normal[k], one.normal[k]);
  }
  take(all.offset, one.offset);
  take(all.id, one.id);
  return one;
}

/// Where two tiles name different faces, both must have that depth there.
void expectFacesUpToTies(const FaceSet& faces, const RasterTransform& transform, const DepthTile& reference,
                         const DepthTile& tile) {
  for (int row = 0; row < tile.rows; ++row) {
    for (int col = 0; col < tile.cols; ++col) {
      const int cell = row * tile.stride + col;
      if (!(reference.depth()[cell] < kEmpty) || tile.face()[cell] == reference.face()[cell]) continue;
      ASSERT_GE(tile.face()[cell], 0);
      ASSERT_LT(tile.face()[cell], static_cast<int>(faces.count));
      DepthTile alone = tile;
      std::fill_n(alone.depth(), alone.tile_rows * kTileSize * alone.stride - DepthTile::kPad, kEmpty);
      rasterizeScalar(onlyFace(faces, tile.face()[cell]), transform, alone);
      ASSERT_EQ(alone.depth()[cell], reference.depth()[cell])
          << "face " << tile.face()[cell] << " instead of " << reference.face()[cell] << " at row " << row << " col "
          << col;
    }
  }
}

TEST_P(EngineOracle, EveryInstructionSetDrawsTheSame) {
  int covered = 0;
  RasterScratch scratch;
  forEachView([&](const PinholeCamera& camera, int, const Pose& pose) {
    const DepthTile reference = drawScalar(object_.faces, pose, camera);
    const RasterTransform transform(pose, camera, reference);
    covered += countCovered(reference);
    forEachTarget([&] {
      for (const bool with_faces : {false, true}) {
        DepthTile tile = emptyTile(pose, camera, 5.5f);
        rasterize(object_.faces, transform, with_faces, tile, scratch);
        ASSERT_EQ(firstDifferentRow(tile, reference.depth(), tile.depth(), 0, tile.cols), -1);
        if (with_faces) expectFacesUpToTies(object_.faces, transform, reference, tile);
      }
    });
  });
  EXPECT_GT(covered, 150000) << "else this test shows little";
}

/// Equal wherever a later stage may look.
void expectSameOutline(const DepthTile& reference, const DepthTile& tile, bool with_distance) {
  ASSERT_EQ(reference.touched, tile.touched);
  for (int row = 0; row < tile.rows; ++row) {
    for (int col = 0; col < tile.tile_cols * kTileSize; ++col) {
      if (tile.touched[static_cast<std::size_t>(row / kTileSize * tile.tile_cols + col / kTileSize)] == 0) continue;
      const int cell = row * tile.stride + col;
      ASSERT_EQ(reference.coverage()[cell], tile.coverage()[cell]) << "row " << row << " col " << col;
      if (reference.coverage()[cell] == 0.0f) continue;
      ASSERT_LT(col, tile.cols) << "beyond the image nothing is covered";
      ASSERT_LT(reference.softDepth()[cell], kEmpty);
      ASSERT_EQ(reference.softDepth()[cell], tile.softDepth()[cell]) << "row " << row << " col " << col;
    }
  }
  if (!with_distance) return;
  // The outline's direction at a cell depends on its neighbours, those beyond the image too.
  ASSERT_EQ(firstDifferentRow(tile, reference.distance(), tile.distance(), -1, tile.cols + 1), -1);
}

TEST_P(EngineOracle, EveryInstructionSetSoftensTheOutlineInTheSameWay) {
  int num_soft = 0;
  forEachView([&](const PinholeCamera& camera, int index, const Pose& pose) {
    const DepthTile drawn = drawScalar(object_.faces, pose, camera);
    for (int reach = 0; reach < 3; ++reach) {
      const OutlineCoverage outline(kEdgeStddevs[reach]);
      ASSERT_EQ(outline.reach, reach);
      const bool with_distance = (index + reach) % 2 == 0;
      DepthTile reference = drawn;
      softenOutlineScalar(outline, with_distance, reference);
      for (int i = 0; i < reference.rows * reference.stride; ++i) {
        num_soft += reference.coverage()[i] > 0.0f && reference.coverage()[i] < 1.0f ? 1 : 0;
      }
      forEachTarget([&] {
        DepthTile tile = drawn;
        poisonAllButDepth(tile, 5.5f);
        softenOutline(outline, with_distance, tile);
        expectSameOutline(reference, tile, with_distance);
      });
    }
  });
  EXPECT_GT(num_soft, 20000) << "else this test shows little";
}

constexpr BeliefScale kBelief = {0.25f, 0.7f, 1.0f / 0.7f, 0.3f};

/// A frame that could be of a rendered object, with missing readings, things before it and behind it.
class RandomFrame {
 public:
  RandomFrame(const DepthTile& tile, const PinholeCamera& camera, const PixelModelConfig& config,
              std::mt19937_64& engine)
      : engine_(engine), image_(config) {
    readings_.resize(static_cast<std::size_t>(camera.width * camera.height));
    for (int row = 0; row < tile.rows; ++row) {
      for (int col = 0; col < tile.cols; ++col) {
        const float depth = tile.depth()[row * tile.stride + col];
        readings_[static_cast<std::size_t>((tile.row_begin + row) * camera.width + tile.col_begin + col)] =
            static_cast<float>(reading(depth < kEmpty ? depth : uniform(0.2, 3.0)));
      }
    }
    image_.setImage(viewOf(readings_, camera), makeSamplingGrid(camera, 1));
    image_.prepare(image_.imageBox());
    believe(tile.touched.size());
  }

  /// Something known stands before or behind the object in some pixels.
  void addOccluders() {
    const SamplingGrid& grid = image_.grid();
    std::vector<float> depth(static_cast<std::size_t>(grid.camera.width * grid.camera.height), 0.0f);
    for (float& value : depth) {
      if (uniform(0.0, 1.0) < 0.5) value = static_cast<float>(uniform(0.2, 2.0));
    }
    image_.setOccluders(depth);
  }

  TileLikelihoodInput input() const { return {image_.planes(), image_.model(), kBelief}; }

  /// Some tiles were never measured.
  std::vector<const float*> beliefs() const {
    std::vector<const float*> pointers;
    for (std::size_t i = 0; i < beliefs_.size(); ++i) pointers.push_back(i % 5 == 2 ? nullptr : beliefs_[i].values);
    return pointers;
  }
  const std::vector<OcclusionTile>& storedBeliefs() const { return beliefs_; }

 private:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }

  double reading(double depth) {
    const double kind = uniform(0.0, 1.0);
    if (kind < 0.1) return 0.0;
    if (kind < 0.12) return std::numeric_limits<double>::quiet_NaN();
    if (kind < 0.25) return depth * uniform(0.3, 1.0);
    if (kind < 0.35) return uniform(0.1, 7.0);
    return depth + std::normal_distribution<double>(0.0, 0.002 + 0.002 * depth * depth)(engine_);
  }

  void believe(std::size_t num_tiles) {
    beliefs_.resize(num_tiles);
    for (OcclusionTile& tile : beliefs_) {
      for (float& value : tile.values) {
        const auto probability = static_cast<float>(std::clamp(uniform(-0.1, 1.1), 0.0, 1.0));
        value = (probability - kBelief.stationary) * kBelief.inverse_scale;
      }
    }
  }

  std::mt19937_64& engine_;
  std::vector<float> readings_;
  MeasuredImage image_;
  std::vector<OcclusionTile> beliefs_;
};

std::vector<float*> pointersTo(std::vector<OcclusionTile>& tiles) {
  std::vector<float*> pointers;
  for (OcclusionTile& tile : tiles) pointers.push_back(tile.values);
  return pointers;
}

int countDifferent(const std::vector<OcclusionTile>& a, const std::vector<OcclusionTile>& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (int cell = 0; cell < kTileCells; ++cell) count += a[i].values[cell] != b[i].values[cell] ? 1 : 0;
  }
  return count;
}

class EngineLikelihood : public EngineOracle {
 protected:
  /// Outline, occluder model and extra noise in all combinations.
  static PixelModelConfig configOf(int index) {
    PixelModelConfig config;
    config.edge_stddev_px = kEdgeStddevs[index % 3];
    config.occluder_model = index / 3 % 2 == 0 ? OccluderModel::kConsistent : OccluderModel::kPaper;
    config.min_p_occluded_in_front = index % 7 == 0 ? 0.0 : 0.5;
    return config;
  }
  static float extraStddev(int index) { return index / 6 % 2 == 0 ? 0.0f : 0.01f; }

  void expectSameLikelihood(const DepthTile& tile, const RandomFrame& frame, float extra_stddev_m) {
    const std::vector<const float*> beliefs = frame.beliefs();
    const double reference = tileLogLikelihoodScalar(tile, frame.input(), beliefs.data(), extra_stddev_m);
    ASSERT_TRUE(std::isfinite(reference));
    sum_of_magnitudes_ += std::abs(reference);
    forEachTarget(
        [&] { ASSERT_EQ(tileLogLikelihood(tile, frame.input(), beliefs.data(), extra_stddev_m), reference); });
  }

  void expectSamePosterior(const DepthTile& tile, const RandomFrame& frame) {
    std::vector<OcclusionTile> reference = frame.storedBeliefs();
    const double log_likelihood = updateTileBeliefsScalar(tile, frame.input(), pointersTo(reference).data());
    num_updated_ += countDifferent(reference, frame.storedBeliefs());
    forEachTarget([&] {
      std::vector<OcclusionTile> posterior = frame.storedBeliefs();
      ASSERT_EQ(updateTileBeliefs(tile, frame.input(), pointersTo(posterior).data()), log_likelihood);
      ASSERT_EQ(countDifferent(posterior, reference), 0);
    });
  }

  void expectSameLinearisation(const DepthTile& tile, const RandomFrame& frame, float extra_stddev_m,
                               const TileGeometry& geometry) {
    const std::vector<const float*> beliefs = frame.beliefs();
    const LinearisationSums reference =
        lineariseTileScalar(tile, frame.input(), beliefs.data(), extra_stddev_m, geometry);
    for (const double value : reference) ASSERT_TRUE(std::isfinite(value));
    trace_of_information_ += reference[6] + reference[8] + reference[11];
    forEachTarget(
        [&] { ASSERT_EQ(lineariseTile(tile, frame.input(), beliefs.data(), extra_stddev_m, geometry), reference); });
  }

  double sum_of_magnitudes_ = 0.0, trace_of_information_ = 0.0;
  int num_updated_ = 0;
};
INSTANTIATE_TEST_SUITE_P(Meshes, EngineLikelihood,
                         testing::Values("drill", "mug", "box", "bottle", "bracket", "open_mug"),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(EngineLikelihood, EveryInstructionSetGivesTheSameNumbers) {
  forEachView([&](const PinholeCamera& camera, int index, const Pose& pose) {
    const PixelModelConfig config = configOf(index);
    const OutlineCoverage outline(config.edge_stddev_px);
    DepthTile tile = drawScalar(object_.faces, pose, camera);
    if (countCovered(tile) == 0) return;
    softenOutlineScalar(outline, true, tile);
    RandomFrame frame(tile, camera, config, engine_);
    if (index % 4 == 1) frame.addOccluders();
    const TileGeometry geometry =
        makeTileGeometry(pose.linear(), pose.translation(), camera, object_.faces, outline, tile);
    expectSameLikelihood(tile, frame, extraStddev(index));
    expectSamePosterior(tile, frame);
    expectSameLinearisation(tile, frame, extraStddev(index), geometry);
  });
  EXPECT_GT(sum_of_magnitudes_, 1e4) << "else this test shows little";
  EXPECT_GT(num_updated_, 100000);
  EXPECT_GT(trace_of_information_, 1e8);
}

/// Both renderers' image of one pose, and what is exact in double precision.
class ExactComparison {
 public:
  ExactComparison(const RenderObject& object, DepthRenderer& exact, const DepthTile& tile, const Pose& pose,
                  const PinholeCamera& camera)
      : object_(object),
        tile_(tile),
        pose_(pose),
        camera_(camera),
        brute_force_(object.mesh, pose, camera, kNearPlaneM) {
    exact_.assign(static_cast<std::size_t>(camera.width * camera.height), nullptr);
    for (const CoveredPixel& pixel : exact.render(pose, camera)) {
      exact_[static_cast<std::size_t>(pixel.row * camera.width + pixel.col)] = &pixel;
    }
  }

  int num_covered = 0;
  int num_near_edge = 0;  ///< pixels that differ because an edge passes close to their centre
  int num_holes = 0;      ///< not covered though the exact image covers them and all around them

  void run() {
    for (int row = 0; row < camera_.height; ++row) {
      for (int col = 0; col < camera_.width; ++col) comparePixel(row, col);
    }
  }

 private:
  const CoveredPixel* exact(int row, int col) const {
    return exact_[static_cast<std::size_t>(row * camera_.width + col)];
  }

  bool inTile(int row, int col) const {
    return row >= tile_.row_begin && row < tile_.row_begin + tile_.rows && col >= tile_.col_begin &&
           col < tile_.col_begin + tile_.cols;
  }

  int cell(int row, int col) const { return (row - tile_.row_begin) * tile_.stride + col - tile_.col_begin; }

  void comparePixel(int row, int col) {
    const CoveredPixel* expected = exact(row, col);
    const float depth = inTile(row, col) ? tile_.depth()[cell(row, col)] : kEmpty;
    if (expected != nullptr) ++num_covered;
    if (depth < kEmpty) expectWithinCorners(row, col, depth);
    if (expected != nullptr && !(depth < kEmpty) && isStrictlyInside(row, col)) ++num_holes;
    if (agrees(expected, depth, row, col)) return;
    ++num_near_edge;
    constexpr double kSnapTolerancePx = 1.0 / 128.0;
    EXPECT_TRUE(brute_force_.cast(row, col, kSnapTolerancePx).is_uncertain)
        << "row " << row << " col " << col << ": " << depth << " instead of "
        << (expected != nullptr ? expected->depth : kEmpty);
  }

  bool agrees(const CoveredPixel* expected, float depth, int row, int col) const {
    if (expected == nullptr || !(depth < kEmpty)) return expected == nullptr && !(depth < kEmpty);
    return isEdgeOn(expected->triangle, row, col) ||
           std::abs(depth - expected->depth) <= 1e-5f * std::abs(expected->depth);
  }

  /// The angle at which the hot loops stop trusting a face.
  bool isEdgeOn(std::uint32_t triangle, int row, int col) const {
    const FaceSet& faces = object_.faces;
    const Eigen::Vector3d normal(faces.normal[0][triangle], faces.normal[1][triangle], faces.normal[2][triangle]);
    const double cosine = (pose_.linear() * normal).dot(camera_.ray(col, row).normalized());
    return cosine * cosine <= static_cast<double>(tile_likelihood::kMinIncidenceSquared);
  }

  void expectWithinCorners(int row, int col, float depth) const {
    double low = 1e9, high = -1e9;
    for (const std::uint32_t corner : object_.mesh.triangles[static_cast<std::size_t>(tile_.face()[cell(row, col)])]) {
      const double z = (pose_ * object_.mesh.vertices[corner].cast<double>()).z();
      low = std::min(low, z);
      high = std::max(high, z);
    }
    EXPECT_GE(depth, low * (1.0 - 1e-6)) << "row " << row << " col " << col;
    EXPECT_LE(depth, high * (1.0 + 1e-6)) << "row " << row << " col " << col;
  }

  bool isStrictlyInside(int row, int col) const {
    if (row < 1 || col < 1 || row + 1 >= camera_.height || col + 1 >= camera_.width) return false;
    for (int i = -1; i <= 1; ++i) {
      for (int j = -1; j <= 1; ++j) {
        if (exact(row + i, col + j) == nullptr) return false;
      }
    }
    return true;
  }

  const RenderObject& object_;
  const DepthTile& tile_;
  const Pose pose_;
  const PinholeCamera camera_;
  BruteForceRenderer brute_force_;
  std::vector<const CoveredPixel*> exact_;
};

TEST_P(EngineOracle, ReferenceDrawsWhatIsExactUpToSnappedCorners) {
  DepthRenderer exact(object_.mesh);
  int num_covered = 0, num_near_edge = 0;
  forEachView([&](const PinholeCamera& camera, int, const Pose& pose) {
    const DepthTile tile = drawScalar(object_.faces, pose, camera);
    ExactComparison comparison(object_, exact, tile, pose, camera);
    comparison.run();
    num_covered += comparison.num_covered;
    num_near_edge += comparison.num_near_edge;
  });
  EXPECT_GT(num_covered, 150000);
  EXPECT_LE(num_near_edge, num_covered / 200) << "few pixel centres lie that close to an edge";
  std::cout << num_near_edge << " of " << num_covered << " pixels differ, too close to an edge to call\n";
}

TEST_P(ClosedMesh, NoPixelInsideIsLeftOut) {
  ASSERT_TRUE(object_.faces.faces_outward);
  DepthRenderer exact(object_.mesh);
  int num_covered = 0;
  for (int i = 0; i < 100; ++i) {
    const Pose pose = randomView(i);
    const PinholeCamera camera = cameraAt(1 + i % 2);
    const DepthTile tile = drawScalar(object_.faces, pose, camera);
    ExactComparison comparison(object_, exact, tile, pose, camera);
    comparison.run();
    num_covered += comparison.num_covered;
    EXPECT_EQ(comparison.num_holes, 0) << "pose " << i;
  }
  EXPECT_GT(num_covered, 150000);
}

/// A pose from which the camera stands at a point of the object frame.
Pose poseOfEye(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& eye_object) {
  Pose pose = Pose::Identity();
  pose.linear() = rotation;
  pose.translation() = -(rotation * eye_object);
  return pose;
}

TEST_P(EngineOracle, FacesThatFaceANearbyEyeAreAllThatIsSeen) {
  FaceSet visible;
  for (int i = 0; i < 30; ++i) {
    const Pose centre = randomView(i);
    const Eigen::Vector3d eye = centre.inverse().translation();
    // The mesh must stay beyond the near plane from every eye.
    const double radius = std::min(0.06 * eye.norm(), 0.5 * (nearestCorner(centre) - kNearPlaneM));
    selectFacing(object_.faces, eye.cast<float>(), static_cast<float>(radius), visible);
    EXPECT_EQ(visible.padded % FaceSet::kPadding, 0u);
    if (object_.faces.faces_outward) {
      EXPECT_LT(visible.count, object_.faces.count * 9 / 10) << "nothing is won";
    } else {
      EXPECT_EQ(visible.count, object_.faces.count);
    }
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector3d direction = randomVector(engine_, 1.0).normalized();
      const Pose pose = poseOfEye(centre.linear(), eye + 0.999 * radius * direction);
      const PinholeCamera camera = cameraAt(2);
      const DepthTile all = drawScalar(object_.faces, pose, camera), some = drawScalar(visible, pose, camera);
      ASSERT_EQ(firstDifferentRow(all, all.depth(), some.depth(), 0, all.cols), -1) << "pose " << i;
      for (int row = 0; row < all.rows; ++row) {
        const std::int32_t* ids = all.face() + row * all.stride;
        ASSERT_TRUE(std::equal(ids, ids + all.cols, some.face() + row * some.stride)) << "pose " << i;
      }
    }
  }
}

class EngineReference : public testing::TestWithParam<OccluderModel> {
 protected:
  static constexpr int kRows = 40, kCols = 56;  // whole tiles

  EngineReference() : camera_(makeCamera(kCols, kRows, 50.0)) {
    config_.occluder_model = GetParam();
    config_.edge_stddev_px = 0.0;
    config_.min_p_occluded_in_front = 0.0;
    tile_.clear(imageOf(camera_), imageOf(camera_));
    for (int row = 0; row < kRows; ++row) {
      for (int col = 0; col < kCols; ++col) {
        tile_.depth()[row * tile_.stride + col] = static_cast<float>(std::exp(uniform(std::log(0.15), std::log(4.0))));
      }
    }
    softenOutlineScalar(OutlineCoverage(0.0), false, tile_);
    frame_.emplace(tile_, camera_, config_, engine_);
  }

  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }

  PixelUpdate expected(int row, int col, float p_occluded) const {
    const float depth = tile_.depth()[row * tile_.stride + col];
    const PixelPlanes planes = frame_->input().planes;
    const float z = planes.depth[row * planes.stride + col];
    return updatePixel(z > kMissingReadingM ? z : 0.0, depth, p_occluded, config_);
  }

  /// A copy of the tile in which only one pixel is covered.
  DepthTile onlyPixel(int row, int col) const {
    DepthTile tile = tile_;
    std::fill(tile.coverage(), tile.coverage() + kRows * tile.stride - DepthTile::kPad, 0.0f);
    tile.coverage()[row * tile.stride + col] = 1.0f;
    std::fill(tile.touched.begin(), tile.touched.end(), std::uint8_t{0});
    tile.touched[static_cast<std::size_t>(tileOf(row, col))] = 1;
    return tile;
  }

  int tileOf(int row, int col) const { return row / kTileSize * tile_.tile_cols + col / kTileSize; }
  static int cellOf(int row, int col) { return row % kTileSize * kTileSize + col % kTileSize; }
  static float probability(float stored) { return kBelief.stationary + kBelief.scale * stored; }

  std::mt19937_64 engine_{77};
  PinholeCamera camera_;
  PixelModelConfig config_;
  DepthTile tile_;
  std::optional<RandomFrame> frame_;
};
INSTANTIATE_TEST_SUITE_P(Models, EngineReference, testing::Values(OccluderModel::kConsistent, OccluderModel::kPaper));

void expectSameLog(double value, double expected) {
  EXPECT_NEAR(value, expected, 1e-3 * std::max(1.0, std::abs(expected)));
}

TEST_P(EngineReference, EveryPixelSaysWhatTheModelSays) {
  const std::vector<const float*> beliefs = frame_->beliefs();
  double sum = 0.0;
  int num_informative = 0;
  for (int row = 0; row < kRows; ++row) {
    for (int col = 0; col < kCols; ++col) {
      const float* tile_beliefs = beliefs[static_cast<std::size_t>(tileOf(row, col))];
      const float stored = tile_beliefs != nullptr ? tile_beliefs[cellOf(row, col)] : kBelief.unmeasured;
      const PixelUpdate update = expected(row, col, probability(stored));
      SCOPED_TRACE("row " + std::to_string(row) + " col " + std::to_string(col));
      expectSameLog(tileLogLikelihoodScalar(onlyPixel(row, col), frame_->input(), beliefs.data(), 0.0f),
                    update.log_ratio);
      sum += update.log_ratio;
      num_informative += std::abs(update.log_ratio) > 0.1 ? 1 : 0;
    }
  }
  EXPECT_GT(num_informative, kRows * kCols / 2);
  expectSameLog(tileLogLikelihoodScalar(tile_, frame_->input(), beliefs.data(), 0.0f), sum);
}

TEST_P(EngineReference, EveryBeliefMovesToItsPosterior) {
  std::vector<OcclusionTile> posterior = frame_->storedBeliefs();
  const double log_likelihood = updateTileBeliefsScalar(tile_, frame_->input(), pointersTo(posterior).data());
  double sum = 0.0, largest_change = 0.0;
  for (int row = 0; row < kRows; ++row) {
    for (int col = 0; col < kCols; ++col) {
      const auto index = static_cast<std::size_t>(tileOf(row, col));
      const float prior = probability(frame_->storedBeliefs()[index].values[cellOf(row, col)]);
      const PixelUpdate update = expected(row, col, prior);
      EXPECT_NEAR(probability(posterior[index].values[cellOf(row, col)]), update.p_occluded, 1e-4)
          << "row " << row << " col " << col << " depth " << tile_.depth()[row * tile_.stride + col] << " z "
          << frame_->input().planes.depth[row * frame_->input().planes.stride + col] << " prior " << prior;
      sum += update.log_ratio;
      largest_change = std::max(largest_change, std::abs(update.p_occluded - static_cast<double>(prior)));
    }
  }
  EXPECT_GT(largest_change, 0.5);
  expectSameLog(log_likelihood, sum);
}

TEST_P(EngineReference, MoreNoiseWidensTheSurface) {
  // The same as readings of a sensor, or a mesh, that is so much worse.
  config_.object_noise_stddev_m = std::hypot(config_.object_noise_stddev_m, 0.01);
  const std::vector<const float*> beliefs = frame_->beliefs();
  const RandomFrame* frame = &*frame_;
  for (int row = 0; row < kRows; row += 3) {
    for (int col = 0; col < kCols; col += 3) {
      const PixelPlanes planes = frame->input().planes;
      const double z = planes.depth[row * planes.stride + col];
      const double d = tile_.depth()[row * tile_.stride + col];
      const float* tile_beliefs = beliefs[static_cast<std::size_t>(tileOf(row, col))];
      const double p = probability(tile_beliefs != nullptr ? tile_beliefs[cellOf(row, col)] : kBelief.unmeasured);
      if (std::abs(z - d) > 3.0 * surfaceNoiseStddev(z, config_)) continue;
      const double value = tileLogLikelihoodScalar(onlyPixel(row, col), frame->input(), beliefs.data(), 0.01f);
      EXPECT_NEAR(value, updatePixel(z, d, p, config_).log_ratio, 1e-2) << "row " << row << " col " << col;
    }
  }
}

TEST(FastMath, ExponentialIsWithinItsStatedError) {
  for (double x = -87.0; x <= 88.0; x += 0.000377) {
    const auto argument = static_cast<float>(x);
    const double expected = std::exp(static_cast<double>(argument));
    ASSERT_NEAR(fastExp(argument), expected, 3e-7 * expected) << x;
  }
  EXPECT_EQ(fastExp(0.0f), 1.0f);
  EXPECT_EQ(fastExp(-88.0f), fastExp(-87.0f));
  EXPECT_EQ(fastExp(-kEmpty), fastExp(-87.0f));
}

TEST(FastMath, LogarithmIsWithinItsStatedError) {
  const auto check = [](float x) {
    const double expected = std::log(static_cast<double>(x));
    ASSERT_NEAR(fastLog(x), expected, 2e-7 * std::abs(expected)) << x;
  };
  for (double exponent = -37.0; exponent <= 38.0; exponent += 0.000171) {
    ASSERT_NO_FATAL_FAILURE(check(static_cast<float>(std::pow(10.0, exponent))));
  }
  // Where the logarithm is small, single floats count.
  for (int i = -200000; i < 200000; ++i) {
    ASSERT_NO_FATAL_FAILURE(check(1.0f + static_cast<float>(i) * std::numeric_limits<float>::epsilon()));
    ASSERT_NO_FATAL_FAILURE(check(1.0f + 1e-6f * static_cast<float>(i)));
  }
  EXPECT_EQ(fastLog(1.0f), 0.0f);
}

TEST(FastMath, NormalTailIsWithinItsStatedError) {
  for (double x = 0.0; x <= 40.0; x += 0.00037) {
    const auto argument = static_cast<float>(x);
    const double exact = 0.5 * std::erfc(static_cast<double>(argument) * M_SQRT1_2);
    const float bell = fastExp(-0.5f * argument * argument);
    ASSERT_NEAR(fastNormalTail(argument, bell), exact, 3e-7) << x;
  }
}

TEST_P(EngineOracle, RendererIsTheSumOfItsStages) {
  TileRenderer renderer;
  const RenderObject other(makePlate(0.1f));
  const OutlineCoverage outline(0.85);
  const PinholeCamera camera = cameraAt(2);
  int num_covered = 0;
  for (int i = 0; i < 60; ++i) {
    // Runs of poses from about the same side, as particles come, and now and then another object.
    const Pose first = beyondNearPlane(poseAtPixel(uniform(50, 250), uniform(40, 200), uniform(0.5, 2.0)), 0.3);
    for (int k = 0; k < 3 + i % 5; ++k) {
      Pose pose = first;
      pose.linear() = expSo3(randomVector(engine_, 0.1)) * pose.linear();
      DepthTile expected = drawScalar(object_.faces, pose, camera);
      softenOutlineScalar(outline, true, expected);
      const DepthTile& tile = renderer.render(object_, pose, camera, outline, true);
      ASSERT_EQ(tile.row_begin, expected.row_begin);
      ASSERT_EQ(tile.col_begin, expected.col_begin);
      ASSERT_EQ(tile.stride, expected.stride);
      ASSERT_EQ(firstDifferentRow(tile, expected.depth(), tile.depth(), 0, tile.cols), -1) << i << ", " << k;
      ASSERT_NO_FATAL_FAILURE(expectSameOutline(expected, tile, true)) << i << ", " << k;
      expectFacesUpToTies(object_.faces, RasterTransform(pose, camera, tile), expected, tile);
      num_covered += countCovered(tile);
    }
    if (i % 4 != 3) continue;
    const DepthTile& tile = renderer.render(other, first, camera, outline, true);
    TileRenderer fresh;
    const DepthTile& expected = fresh.render(other, first, camera, outline, true);
    ASSERT_EQ(tile.touched, expected.touched);
    ASSERT_EQ(firstDifferentRow(tile, expected.depth(), tile.depth(), 0, tile.cols), -1);
  }
  EXPECT_GT(num_covered, 10000);
}

TEST_P(EngineOracle, CoveredBoxHoldsTheObjectAndItsOutline) {
  constexpr int kReach = 2;
  DepthRenderer exact(object_.mesh);
  double covered = 0.0, boxes = 0.0;
  forEachView([&](const PinholeCamera& camera, int, const Pose& pose) {
    const CellBox box = TileRenderer::coveredBox(object_, pose, camera);
    EXPECT_TRUE(imageOf(camera).contains(box));
    CellBox drawn;
    for (const CoveredPixel& pixel : exact.render(pose, camera)) {
      drawn = unite(drawn, {pixel.row - kReach, pixel.row + kReach + 1, pixel.col - kReach, pixel.col + kReach + 1});
    }
    EXPECT_TRUE(box.contains(intersect(drawn, imageOf(camera))));
    covered += drawn.empty() ? 0.0 : 1.0 * drawn.rows() * drawn.cols();
    boxes += box.empty() ? 0.0 : 1.0 * box.rows() * box.cols();
  });
  EXPECT_LT(boxes, 2.0 * covered) << "not much larger than need be";
}

bool isEmpty(const DepthTile& tile) {
  return std::all_of(tile.touched.begin(), tile.touched.end(), [](std::uint8_t flag) { return flag == 0; }) &&
         countCovered(tile) == 0;
}

TEST_P(EngineOracle, BehindTheCameraOrOutsideOfTheImageThereIsNothing) {
  const OutlineCoverage outline(0.85);
  forEachTarget([&] {
    TileRenderer renderer;
    for (const bool for_derivatives : {false, true}) {
      for (int i = 0; i < 10; ++i) {
        for (const Pose& pose : {poseAtPixel(150, 120, -uniform(0.4, 3.0)), poseAtPixel(-1500, 120, 0.5),
                                 poseAtPixel(1800, 120, 0.5), poseAtPixel(150, -1500, 0.5), poseAtPixel(150, 1700, 0.5),
                                 poseAtPixel(1e7, 1e7, 2.0), poseAtPixel(-1e9, 120, 2.0)}) {
          EXPECT_TRUE(isEmpty(renderer.render(object_, pose, kFullCamera, outline, for_derivatives)))
              << pose.translation().transpose();
        }
      }
    }
    EXPECT_FALSE(isEmpty(renderer.render(object_, poseAtPixel(150, 120, 0.6), kFullCamera, outline, false)));
  });
}

TEST_P(EngineOracle, AcrossTheNearPlaneTheExactRendererDraws) {
  const PinholeCamera camera = cameraAt(3);
  DepthRenderer exact(object_.mesh);
  TileRenderer renderer;
  int num_cut = 0, num_covered = 0;
  for (int i = 0; i < 20; ++i) {
    const Pose pose = poseAtPixel(uniform(50, 250), uniform(40, 200), uniform(0.0, 0.08));
    if (nearestCorner(pose) > kNearPlaneM) continue;
    ++num_cut;
    const DepthTile& tile = renderer.render(object_, pose, camera, OutlineCoverage(0.85), true);
    std::size_t num_exact = 0;
    for (const CoveredPixel& pixel : exact.render(pose, camera)) {
      const int cell = (pixel.row - tile.row_begin) * tile.stride + pixel.col - tile.col_begin;
      ASSERT_EQ(tile.depth()[cell], pixel.depth);
      ASSERT_EQ(tile.face()[cell], static_cast<std::int32_t>(pixel.triangle));
      ASSERT_GE(tile.coverage()[cell], 0.5f);
      ++num_exact;
    }
    ASSERT_EQ(countCovered(tile), static_cast<int>(num_exact));
    num_covered += static_cast<int>(num_exact);
  }
  EXPECT_GE(num_cut, 10);
  EXPECT_GT(num_covered, 1000);
}

TEST_P(EngineOracle, RendererAllocatesNothingAfterWarmUp) {
  if (!COUNTS_ALLOCATIONS) GTEST_SKIP() << "sanitizers bring their own operator new";
  const OutlineCoverage outline(0.85);
  PinholeCamera fine = kFullCamera;
  for (double* value : {&fine.fx, &fine.fy, &fine.cx, &fine.cy}) *value *= 4.0;
  fine.width *= 4;
  fine.height *= 4;
  std::vector<Pose> poses;
  for (int i = 0; i < 40; ++i) {
    poses.push_back(beyondNearPlane(poseAtPixel(uniform(50, 250), uniform(40, 200), uniform(0.5, 2.0)), 0.3));
  }
  forEachTarget([&] {
    TileRenderer renderer;
    const std::size_t before = num_allocations;
    renderer.render(object_, poseAtPixel(158, 121, 0.6), fine, outline, true);
    const std::size_t warm = num_allocations;
    ASSERT_GT(warm, before) << "allocations are not counted";
    for (const Pose& pose : poses) {
      for (const bool for_derivatives : {false, true}) {
        renderer.render(object_, pose, kFullCamera, outline, for_derivatives);
      }
    }
    EXPECT_EQ(num_allocations - warm, 0u);
  });
}

}  // namespace
}  // namespace depth_object_tracker
