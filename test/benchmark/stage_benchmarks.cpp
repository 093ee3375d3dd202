// SPDX-License-Identifier: BSD-3-Clause
// Google Benchmark of the engine's stages, each alone. The environment variable DEPTH_OBJECT_TRACKER_SIMD picks the
// instruction set. Every stage walks over several poses: on one alone, processors learn its branches by heart.
#include "benchmark_object.h"
#include "benchmark_scene.h"

#include "depth_object_tracker/filter/occlusion_tiles.h"
#include "depth_object_tracker/filter/tile_likelihood.h"
#include "depth_object_tracker/geometry/simd_target.h"
#include "depth_object_tracker/render/depth_renderer.h"
#include "depth_object_tracker/render/tile_renderer.h"

#include <benchmark/benchmark.h>

#include <map>
#include <memory>
#include <vector>

namespace depth_object_tracker {
namespace {

constexpr int kFactor = 5, kCoveredPixels = 430, kTriangles = 5000, kPoses = 16;
constexpr double kEdgeStddevPx = 0.8;

/// A scene with its object, and poses to evaluate.
struct Workplace {
  explicit Workplace(int triangles)
      : mesh(makeBenchmarkObject(triangles)),
        object(mesh),
        scene(mesh, kFactor, kCoveredPixels),
        poses(scene.drawPoses(kPoses, 1)),
        image(PixelModelConfig()) {
    for (Pose& pose : poses) pose = scene.toObject(pose);
    for (const Pose& pose : poses) box = unite(box, TileRenderer::coveredBox(object, pose, camera()));
    image.setImage(scene.frame(0), scene.grid());
    image.prepare(box);
    const Eigen::Vector3f eye = eyeOf(scene.toObject(scene.meanPose()));
    selectFacing(object.faces, eye, 0.06f * eye.norm(), facing);
  }

  const PinholeCamera& camera() const { return scene.grid().camera; }
  static Eigen::Vector3f eyeOf(const Pose& T_camera_object) {
    return T_camera_object.inverse().translation().cast<float>();
  }
  void clear(const Pose& T_camera_object, DepthTile& tile) const {
    tile.clear(TileRenderer::coveredBox(object, T_camera_object, camera()), {0, camera().height, 0, camera().width});
  }

  TriangleMesh mesh;
  RenderObject object;
  BenchmarkScene scene;
  std::vector<Pose> poses;  // T_camera_object
  MeasuredImage image;
  CellBox box;
  FaceSet facing;
};

/// Tiles as they come out of the renderer, with beliefs of their own.
struct RenderedPoses {
  RenderedPoses(const Workplace& at, bool for_derivatives)
      : outline(outlineOn(at.scene.grid(), kEdgeStddevPx)), tiles(kPoses), beliefs(kPoses), pointers(kPoses) {
    RasterScratch scratch;
    for (std::size_t i = 0; i < kPoses; ++i) {
      at.clear(at.poses[i], tiles[i]);
      const RasterTransform transform(at.poses[i], at.camera(), tiles[i]);
      rasterize(at.facing, transform, true, tiles[i], scratch);
      softenOutline(outline, for_derivatives, tiles[i]);
      beliefs[i].resize(tiles[i].touched.size() * kTileCells);  // stored 0 = the chain's stationary probability
      for (std::size_t k = 0; k < tiles[i].touched.size(); ++k) {
        pointers[i].push_back(beliefs[i].data() + k * kTileCells);
      }
    }
    input.planes = at.image.planes();
    input.model = at.image.model();
    input.belief = {0.25f, 1.0f, 1.0f, 0.0f};
  }

  const float* const* constBeliefs(std::size_t i) const { return pointers[i].data(); }

  OutlineCoverage outline;
  std::vector<DepthTile> tiles;
  std::vector<AlignedVector<float>> beliefs;
  std::vector<std::vector<float*>> pointers;
  TileLikelihoodInput input{};
};

/// Index of the next pose, over and over.
class Cycle {
 public:
  std::size_t next() { return index_ = (index_ + 1) % kPoses; }

 private:
  std::size_t index_ = 0;
};

const Workplace& workplace(int triangles) {
  static std::map<int, std::unique_ptr<Workplace>> workplaces;
  auto& found = workplaces[triangles];
  if (found == nullptr) found = std::make_unique<Workplace>(triangles);
  return *found;
}

void selectFacingFaces(benchmark::State& state) {
  const Workplace& at = workplace(static_cast<int>(state.range(0)));
  const Eigen::Vector3f eye = Workplace::eyeOf(at.poses[0]);
  FaceSet visible;
  for (auto _ : state) {
    selectFacing(at.object.faces, eye, 0.06f * eye.norm(), visible);
    benchmark::DoNotOptimize(visible.count);
  }
  state.counters["faces"] = static_cast<double>(visible.count);
}

void rasterizeFaces(benchmark::State& state, bool facing_only, bool with_faces) {
  const Workplace& at = workplace(static_cast<int>(state.range(0)));
  const FaceSet& faces = facing_only ? at.facing : at.object.faces;
  DepthTile tile;
  RasterScratch scratch;
  Cycle cycle;
  for (auto _ : state) {
    const Pose& pose = at.poses[cycle.next()];
    at.clear(pose, tile);
    rasterize(faces, RasterTransform(pose, at.camera(), tile), with_faces, tile, scratch);
    benchmark::DoNotOptimize(tile.depth());
  }
}

void boxAndClear(benchmark::State& state) {
  const Workplace& at = workplace(kTriangles);
  DepthTile tile;
  Cycle cycle;
  for (auto _ : state) {
    at.clear(at.poses[cycle.next()], tile);
    benchmark::DoNotOptimize(tile.depth());
  }
}

void exactRenderer(benchmark::State& state) {
  const Workplace& at = workplace(static_cast<int>(state.range(0)));
  DepthRenderer renderer(at.mesh);
  Cycle cycle;
  for (auto _ : state) benchmark::DoNotOptimize(renderer.render(at.poses[cycle.next()], at.camera()).size());
}

/// @param edge_stddev_px of the grid; 0, 0.34 and 0.8 make 0, 1 and 2 rings.
void soften(benchmark::State& state, double edge_stddev_px, bool with_distance) {
  RenderedPoses rendered(workplace(kTriangles), false);
  const OutlineCoverage outline(edge_stddev_px);
  Cycle cycle;
  for (auto _ : state) {
    DepthTile& tile = rendered.tiles[cycle.next()];
    softenOutline(outline, with_distance, tile);
    benchmark::DoNotOptimize(tile.coverage());
  }
  state.counters["rings"] = outline.reach;
}

void logLikelihood(benchmark::State& state, float extra_stddev_m) {
  const RenderedPoses rendered(workplace(kTriangles), false);
  Cycle cycle;
  for (auto _ : state) {
    const std::size_t i = cycle.next();
    benchmark::DoNotOptimize(
        tileLogLikelihood(rendered.tiles[i], rendered.input, rendered.constBeliefs(i), extra_stddev_m));
  }
}

void updateBeliefs(benchmark::State& state) {
  RenderedPoses rendered(workplace(kTriangles), false);
  Cycle cycle;
  for (auto _ : state) {
    const std::size_t i = cycle.next();
    benchmark::DoNotOptimize(updateTileBeliefs(rendered.tiles[i], rendered.input, rendered.pointers[i].data()));
  }
}

void linearise(benchmark::State& state) {
  const Workplace& at = workplace(kTriangles);
  const RenderedPoses rendered(at, true);
  Cycle cycle;
  for (auto _ : state) {
    const std::size_t i = cycle.next();
    const Pose& pose = at.poses[i];
    const TileGeometry geometry = makeTileGeometry(pose.linear(), pose * at.scene.centreObject(), at.camera(),
                                                   at.object.faces, rendered.outline, rendered.tiles[i]);
    benchmark::DoNotOptimize(
        lineariseTile(rendered.tiles[i], rendered.input, rendered.constBeliefs(i), 0.0f, geometry));
  }
}

/// Every particle writes every tile of the region of interest.
void writeAll(const CellBox& box, int num_particles, OcclusionTiles& memory) {
  for (int row = box.row_begin / kTileSize; row * kTileSize < box.row_end; ++row) {
    for (int col = box.col_begin / kTileSize; col * kTileSize < box.col_end; ++col) {
      for (int particle = 0; particle < num_particles; ++particle) {
        memory.writableTile(particle, row * memory.tileCols() + col, 0);
      }
    }
  }
}

void resampleMemory(benchmark::State& state) {
  const Workplace& at = workplace(kTriangles);
  const auto num_particles = static_cast<int>(state.range(0));
  OcclusionTiles memory(OcclusionChainConfig(), num_particles, 1);
  memory.setGrid(at.camera().height, at.camera().width);
  const std::vector<int> ancestry = drawAncestry(num_particles, 1);
  for (auto _ : state) {
    state.PauseTiming();
    writeAll(at.box, num_particles, memory);
    state.ResumeTiming();
    memory.resample(ancestry);
  }
  state.SetItemsProcessed(state.iterations() * num_particles);
}

void updateMeanOfMemory(benchmark::State& state) {
  const Workplace& at = workplace(kTriangles);
  const auto num_particles = static_cast<int>(state.range(0));
  OcclusionTiles memory(OcclusionChainConfig(), num_particles, 1);
  memory.setGrid(at.camera().height, at.camera().width);
  writeAll(at.box, num_particles, memory);
  const std::vector<double> weights(static_cast<std::size_t>(num_particles), 1.0 / num_particles);
  for (auto _ : state) memory.updateMean(weights);
  state.SetItemsProcessed(state.iterations() * num_particles);
}

void prepareImage(benchmark::State& state) {
  const Workplace& at = workplace(kTriangles);
  MeasuredImage image((PixelModelConfig()));
  int frame = 0;
  for (auto _ : state) {
    image.setImage(at.scene.frame(frame++), at.scene.grid());
    image.prepare(at.box);
    benchmark::DoNotOptimize(image.planes().depth);
  }
}

BENCHMARK(selectFacingFaces)->Arg(1000)->Arg(5000)->Arg(20000);
BENCHMARK(boxAndClear);
BENCHMARK_CAPTURE(rasterizeFaces, facing, true, false)->Arg(1000)->Arg(5000)->Arg(20000)->Arg(100000);
BENCHMARK_CAPTURE(rasterizeFaces, all, false, false)->Arg(1000)->Arg(5000)->Arg(20000);
BENCHMARK_CAPTURE(rasterizeFaces, facing_with_ids, true, true)->Arg(1000)->Arg(5000)->Arg(20000);
BENCHMARK(exactRenderer)->Arg(1000)->Arg(5000)->Arg(20000)->Arg(100000);
BENCHMARK_CAPTURE(soften, hard, 0.0, false);
BENCHMARK_CAPTURE(soften, one_ring, 0.34, false);
BENCHMARK_CAPTURE(soften, two_rings, 0.8, false);
BENCHMARK_CAPTURE(soften, distance, 0.8, true);
BENCHMARK_CAPTURE(logLikelihood, plain, 0.0f);
BENCHMARK_CAPTURE(logLikelihood, broad, 0.005f);
BENCHMARK(updateBeliefs);
BENCHMARK(linearise);
BENCHMARK(resampleMemory)->Arg(200)->Arg(2000)->Unit(benchmark::kMicrosecond);
BENCHMARK(updateMeanOfMemory)->Arg(200)->Arg(2000)->Unit(benchmark::kMicrosecond);
BENCHMARK(prepareImage);

}  // namespace
}  // namespace depth_object_tracker

int main(int argc, char** argv) {
  benchmark::AddCustomContext("simd", depth_object_tracker::simdTarget());
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
